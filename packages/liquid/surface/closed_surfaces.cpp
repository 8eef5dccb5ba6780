#include "liquid/surface/closed_surfaces.hpp"

#include "liquid/common/cell_groups.hpp"

namespace lockstep {

namespace {
/// Cells that the surface passes between: the surfaces' own, and those of them beside an end of
/// what is theirs.
struct SurfaceCells {
  std::vector<char> members, ends;
};

template <int dim>
SurfaceCells find_surface_cells(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                const std::vector<char>& is_dry) {
  const TiledGrid<dim>& grid = domain.grid;
  SurfaceCells cells{std::vector<char>(is_dry.size(), 0), std::vector<char>(is_dry.size(), 0)};
  grid.for_each_owned_cell([&](int cell) {
    bool ends = false, is_crossed = false;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = grid.neighbor(cell, i / 2, i % 2);
      const bool is_there =
          other >= 0 && grid.in_domain(other) && geometry.state.cells[other] != CellState::solid;
      ends = ends || !is_there;
      is_crossed = is_crossed || (is_there && is_dry[cell] != is_dry[other]);
    }
    cells.members[cell] = is_crossed;
    cells.ends[cell] = is_crossed && (ends || geometry.near_surface(cell));
  });
  domain.halo.fill(cells.members);
  return cells;
}
}  // namespace

template <int dim>
void hold_closed_surfaces(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                          const std::vector<char>& is_dry, std::vector<SurfacePush>& pushes) {
  const SurfaceCells cells = find_surface_cells(domain, geometry, is_dry);
  const CellGroups surfaces =
      find_groups(domain, find_solid_cells<dim>(domain, nullptr), cells.members);
  const std::size_t n = surfaces.n;
  std::vector<double> force(dim * n, 0), weight(dim * n, 0), n_ends(n, 0);
  domain.grid.for_each_owned_cell([&](int cell) {
    if (cells.ends[cell])
      ++n_ends[surfaces.of_cell[cell]];
  });
  const auto entry = [&](const SurfacePush& push) {
    return dim * surfaces.of_cell[push.face] + push.axis;
  };
  for (const SurfacePush& push : pushes) {
    const double area =
        geometry.mass(push.axis, push.face) * geometry.face_table(push.axis, push.face).gradient;
    force[entry(push)] += push.jump * area;
    weight[entry(push)] += area;
  }
  sum_over_ranks(domain.grid.comm(), force, weight, n_ends);
  for (SurfacePush& push : pushes)
    if (n_ends[surfaces.of_cell[push.face]] == 0)
      push.jump -= force[entry(push)] / weight[entry(push)];
}

template void hold_closed_surfaces<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                      const std::vector<char>&, std::vector<SurfacePush>&);
template void hold_closed_surfaces<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                      const std::vector<char>&, std::vector<SurfacePush>&);

}  // namespace lockstep
