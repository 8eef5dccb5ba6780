#include "liquid/common/dry_cells.hpp"

#include "liquid/common/flood.hpp"
#include "liquid/common/seen_cells.hpp"

namespace lockstep {

template <int dim>
std::vector<char> find_dry_cells(const MacDomain<dim>& domain, const SignedDistance<dim>& distance,
                                 const NearbySurface<dim>& surface,
                                 const std::vector<Point<dim>>& points) {
  const TiledGrid<dim>& grid = domain.grid;
  std::vector<char> dry(grid.n_stored_cells(), 0);
  std::vector<int> front;
  for (const Point<dim>& point : points) {
    const std::string name = fmt::format("dry point {} in \"Free Surface\"",
                                         fmt::join(point.data(), point.data() + dim, ", "));
    for (const int start : cells_seen_from_given<dim>(point, name, domain, surface))
      if (!dry[start] && distance(grid.center(start)) < 0) {
        dry[start] = 1;
        front.push_back(start);
      }
  }
  const auto may_pass = [&](int cell, int other) {
    const Point<dim> from = grid.center(cell), x = grid.center(other);
    return distance(x) < 0 &&
           (surface.empty() || (!surface.first_hit(from, from + way_between(domain, from, x)) &&
                                surface.snapshot().inside(x) < 0));
  };
  flood(domain, std::move(front), may_pass, dry);
  domain.full_halo.fill(dry);
  return dry;
}

template std::vector<char> find_dry_cells<2>(const MacDomain<2>&, const SignedDistance<2>&,
                                             const NearbySurface<2>&, const std::vector<Point<2>>&);
template std::vector<char> find_dry_cells<3>(const MacDomain<3>&, const SignedDistance<3>&,
                                             const NearbySurface<3>&, const std::vector<Point<3>>&);

}  // namespace lockstep
