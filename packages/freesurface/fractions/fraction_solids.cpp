#include "freesurface/fractions/fraction_solids.hpp"

#include <algorithm>

#include "geometry/solid_volume.hpp"

namespace lockstep {

namespace {
/// Cells that a surface may sweep over at once, one behind the other.
constexpr int deepest_sweep = 8;

/// Calls f(other) for the fluid cells beside one that a closed solid holds.
template <int dim, typename Function>
void for_each_fluid_neighbor(const TiledGrid<dim>& grid, const SolidCells<dim>& solids, int cell,
                             const Function& f) {
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = grid.neighbor(cell, i / 2, i % 2);
    if (other >= 0 && solids.is_fluid(other))
      f(other);
  }
}
}  // namespace

template <int dim>
CellField open_parts(const MacDomain<dim>& domain, const SolidCells<dim>& solids) {
  CellField open;
  if (!solids.state.surface)
    return open;
  open.assign(domain.grid.n_stored_cells(), 1.0);
  const Point<dim> half = Point<dim>::Constant(0.5 * domain.spacing());
  domain.grid.for_each_owned_cell([&](int cell) {
    if (solids.near[cell]) {
      const Point<dim> center = domain.grid.center(cell);
      const double solid =
          solid_volume_in_box<dim>(*solids.state.surface, Box<dim>(center - half, center + half));
      open[cell] = std::clamp(1 - solid / domain.cell_volume(), 0.0, 1.0);
    } else if (!solids.is_fluid(cell)) {
      open[cell] = 0;
    }
  });
  domain.full_halo.fill(open);
  return open;
}

template <int dim>
void bring_out_of_solids(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                         Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  CellField share(fractions.owed.size(), 0.0);
  grid.for_each_owned_cell([&](int cell) {
    if (solids.is_fluid(cell) || fractions.owed[cell] == 0)
      return;
    int n = 0;
    for_each_fluid_neighbor(grid, solids, cell, [&](int) { ++n; });
    if (n == 0)
      return;
    share[cell] = fractions.owed[cell] / n;
    fractions.owed[cell] = 0;
  });
  domain.halo.fill(share);
  grid.for_each_stored_cell([&](int cell) {
    if (share[cell] != 0)
      for_each_fluid_neighbor(grid, solids, cell, [&](int other) {
        if (grid.owned(other))
          fractions.owed[other] += share[cell];
      });
  });
}

template <int dim>
double give_up_cells(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                     std::vector<char>& leaves, Fractions& fractions) {
  const TiledGrid<dim>& grid = domain.grid;
  domain.halo.fill(leaves);
  // How many cells the nearest one is away that stays.
  std::vector<int> layer(leaves.size(), 0), donors;
  grid.for_each_stored_cell([&](int cell) {
    if (!leaves[cell])
      return;
    layer[cell] = deepest_sweep + 1;
    donors.push_back(cell);
  });
  const auto for_each_nearer = [&](int cell, const auto& f) {
    for (int i = 0; i < 2 * dim; ++i)
      if (const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
          other >= 0 && layer[other] == layer[cell] - 1)
        f(other);
  };
  for (int depth = 1; depth <= deepest_sweep; ++depth) {
    for (const int cell : donors)
      for (int i = 0; grid.owned(cell) && i < 2 * dim && layer[cell] > depth; ++i)
        if (const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
            other >= 0 && layer[other] == depth - 1)
          layer[cell] = depth;
    domain.halo.fill(layer);
  }
  double stranded = 0;
  CellField share(leaves.size(), 0.0);
  for (int depth = deepest_sweep + 1; depth > 0; --depth) {
    for (const int cell : donors) {
      if (!grid.owned(cell) || layer[cell] != depth)
        continue;
      const double amount =
          fractions.owed[cell] + fractions.liquid[cell] * fractions.open_part(cell);
      fractions.owed[cell] = fractions.liquid[cell] = 0;
      int n = 0;
      if (depth <= deepest_sweep)
        for_each_nearer(cell, [&](int) { ++n; });
      share[cell] = n > 0 ? amount / n : 0;
      stranded += n > 0 ? 0 : amount;
    }
    domain.halo.fill(share);
    for (const int cell : donors)
      if (layer[cell] == depth && depth <= deepest_sweep)
        for_each_nearer(cell, [&](int other) {
          if (grid.owned(other))
            fractions.owed[other] += share[cell];
        });
  }
  return stranded;
}

template CellField open_parts<2>(const MacDomain<2>&, const SolidCells<2>&);
template CellField open_parts<3>(const MacDomain<3>&, const SolidCells<3>&);
template void bring_out_of_solids<2>(const MacDomain<2>&, const SolidCells<2>&, Fractions&);
template void bring_out_of_solids<3>(const MacDomain<3>&, const SolidCells<3>&, Fractions&);
template double give_up_cells<2>(const MacDomain<2>&, const SolidCells<2>&, std::vector<char>&,
                                 Fractions&);
template double give_up_cells<3>(const MacDomain<3>&, const SolidCells<3>&, std::vector<char>&,
                                 Fractions&);

}  // namespace lockstep
