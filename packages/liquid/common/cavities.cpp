#include "liquid/common/cavities.hpp"

#include <algorithm>

#include "liquid/common/cell_groups.hpp"
#include "staggered/domain/cell_at_side.hpp"

namespace lockstep {

namespace {
/// Cells deeper in the air than this belong to a component that is too large to be filled [cells].
constexpr double deep = 3;
/// Least and largest depth of a filled cell [cells].
constexpr double least_depth = 1e-3, most_depth = 0.1;
}  // namespace

template <int dim>
bool at_open_side(const MacDomain<dim>& domain, int cell) {
  return at_side(domain, cell, [](const BoundarySide<dim>& side) {
    return !side.closed() && side.type != SideType::periodic;
  });
}

template <int dim>
std::vector<int> fill_cavities(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                               int most_cells, CellField& phi) {
  std::vector<int> filled;
  if (most_cells == 0)
    return filled;
  const TiledGrid<dim>& grid = domain.grid;
  const double h = domain.spacing();
  std::vector<char> is_air(phi.size());
  for (std::size_t cell = 0; cell < phi.size(); ++cell)
    is_air[cell] = phi[cell] >= 0 && phi[cell] < deep * h;
  const CellGroups voids = find_groups(domain, solids, is_air);

  std::vector<int> n_cells(voids.n, 0), n_wet(voids.n, 0), n_kept(voids.n, 0);
  grid.for_each_owned_cell([&](int cell) {
    const int group = voids.of_cell[cell];
    if (group < 0)
      return;
    ++n_cells[group];
    n_kept[group] += at_open_side(domain, cell);
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
      if (other < 0)
        continue;
      n_wet[group] += phi[other] < 0;
      n_kept[group] += phi[other] >= deep * h;
    }
  });
  sum_over_ranks(grid.comm(), n_cells, n_wet, n_kept);
  std::vector<char> is_small(voids.n);
  for (int group = 0; group < voids.n; ++group)
    is_small[group] = n_cells[group] <= most_cells && n_wet[group] > 0 && n_kept[group] == 0;
  if (std::count(is_small.begin(), is_small.end(), 1) == 0)
    return filled;

  const CellGroups& spaces = find_closed_spaces(domain, solids);
  const auto is_in_small = [&](int cell) {
    return voids.of_cell[cell] >= 0 && is_small[voids.of_cell[cell]];
  };
  std::vector<double> remaining(spaces.n, 0.0);
  grid.for_each_owned_cell([&](int cell) {
    if (spaces.of_cell[cell] >= 0 && phi[cell] >= 0 && !is_in_small(cell))
      remaining[spaces.of_cell[cell]] += 1;
  });
  sum_over_ranks(grid.comm(), remaining);
  grid.for_each_owned_cell([&](int cell) {
    if (!is_in_small(cell) || remaining[spaces.of_cell[cell]] == 0)
      return;
    phi[cell] = -std::clamp(phi[cell], least_depth * h, most_depth * h);
    filled.push_back(cell);
  });
  domain.halo.fill(phi);
  return filled;
}

template bool at_open_side<2>(const MacDomain<2>&, int);
template bool at_open_side<3>(const MacDomain<3>&, int);
template std::vector<int> fill_cavities<2>(const MacDomain<2>&, const SolidCells<2>&, int,
                                           CellField&);
template std::vector<int> fill_cavities<3>(const MacDomain<3>&, const SolidCells<3>&, int,
                                           CellField&);

}  // namespace lockstep
