#include "mac/liquid/seen_cells.hpp"

namespace lockstep {

template <int dim>
std::vector<int> cells_seen_from(const Point<dim>& point, const TiledGrid<dim>& grid,
                                 const NearbySurface<dim>& surface) {
  std::vector<int> seen;
  for (int k = 0; k < 1 << dim; ++k) {
    Point<dim> corner = point;
    for (int a = 0; a < dim; ++a)
      corner[a] += (k >> a & 1 ? 0.5 : -0.5) * grid.spacing();
    const int cell = grid.cell_containing(corner);
    if (cell >= 0 && grid.owned(cell) && grid.in_domain(cell) &&
        (surface.empty() || !surface.first_hit(point, grid.center(cell))))
      seen.push_back(cell);
  }
  return seen;
}

template std::vector<int> cells_seen_from<2>(const Point<2>&, const TiledGrid<2>&,
                                             const NearbySurface<2>&);
template std::vector<int> cells_seen_from<3>(const Point<3>&, const TiledGrid<3>&,
                                             const NearbySurface<3>&);

}  // namespace lockstep
