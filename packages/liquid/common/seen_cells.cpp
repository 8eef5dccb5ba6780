#include "liquid/common/seen_cells.hpp"

#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
Point<dim> way_between(const MacDomain<dim>& domain, const Point<dim>& from, const Point<dim>& to) {
  Point<dim> way = to - from;
  for (int a = 0; a < dim; ++a) {
    const double period = domain.grid.n_cells()[a] * domain.spacing();
    if (domain.boundary.periodic(a))
      way[a] -= period * std::round(way[a] / period);
  }
  return way;
}

template <int dim>
std::vector<int> cells_seen_from(const Point<dim>& point, const MacDomain<dim>& domain,
                                 const NearbySurface<dim>& surface) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<int> seen;
  for (int k = 0; k < 1 << dim; ++k) {
    Point<dim> corner = point;
    for (int a = 0; a < dim; ++a)
      corner[a] += (k >> a & 1 ? 0.5 : -0.5) * grid.spacing();
    const int cell = grid.cell_containing(corner);
    if (cell < 0 || !grid.owned(cell) || !grid.in_domain(cell))
      continue;
    const Point<dim> way = way_between<dim>(domain, point, grid.center(cell));
    if (surface.empty() || !surface.first_hit(point, point + way))
      seen.push_back(cell);
  }
  return seen;
}

template <int dim>
std::vector<int> cells_seen_from_given(const Point<dim>& point, const std::string& name,
                                       const MacDomain<dim>& domain,
                                       const NearbySurface<dim>& surface) {
  const TiledGrid<dim>& grid = domain.grid;
  const int cell = grid.cell_containing(point);
  const bool here = cell >= 0 && grid.owned(cell) && grid.in_domain(cell);
  check_input(sum_all(grid.comm(), static_cast<GlobalIndex>(here)) > 0,
              "The {} lies outside of the domain.", name);
  check_input(surface.empty() || surface.snapshot().inside(point) < 0,
              "The {} lies inside a solid.", name);
  std::vector<int> seen = cells_seen_from<dim>(point, domain, surface);
  check_input(sum_all(grid.comm(), static_cast<GlobalIndex>(seen.size())) > 0,
              "The {} sees no centre of a cell; move it away from the solids, or take smaller "
              "cells.",
              name);
  return seen;
}

template Point<2> way_between<2>(const MacDomain<2>&, const Point<2>&, const Point<2>&);
template Point<3> way_between<3>(const MacDomain<3>&, const Point<3>&, const Point<3>&);
template std::vector<int> cells_seen_from<2>(const Point<2>&, const MacDomain<2>&,
                                             const NearbySurface<2>&);
template std::vector<int> cells_seen_from<3>(const Point<3>&, const MacDomain<3>&,
                                             const NearbySurface<3>&);
template std::vector<int> cells_seen_from_given<2>(const Point<2>&, const std::string&,
                                                   const MacDomain<2>&, const NearbySurface<2>&);
template std::vector<int> cells_seen_from_given<3>(const Point<3>&, const std::string&,
                                                   const MacDomain<3>&, const NearbySurface<3>&);

}  // namespace lockstep
