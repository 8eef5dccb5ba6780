#include "liquid/common/dry_cells.hpp"

#include "base/errors.hpp"
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
    const std::string x = fmt::format("{}", fmt::join(point.data(), point.data() + dim, ", "));
    const int cell = grid.cell_containing(point);
    const bool here = cell >= 0 && grid.owned(cell) && grid.in_domain(cell);
    check_input(sum_all(grid.comm(), static_cast<GlobalIndex>(here)) > 0,
                "The dry point {} in \"Free Surface\" lies outside of the domain.", x);
    check_input(surface.empty() || surface.snapshot().inside(point) < 0,
                "The dry point {} in \"Free Surface\" lies inside a solid.", x);
    const std::vector<int> seen = cells_seen_from<dim>(point, domain, surface);
    check_input(sum_all(grid.comm(), static_cast<GlobalIndex>(seen.size())) > 0,
                "The dry point {} in \"Free Surface\" sees no centre of a cell; move it away from "
                "the solids, or take smaller cells.",
                x);
    for (const int start : seen)
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
