#include "liquid/watch/watched_places.hpp"

#include <algorithm>
#include <limits>

#include "base/errors.hpp"
#include "liquid/common/flood.hpp"
#include "liquid/common/seen_cells.hpp"
#include "liquid/watch/swept_cells.hpp"
#include "parameters/mistakes.hpp"

namespace lockstep {

namespace {
constexpr int most_watches = 30;
/// Reported value of a place of which no cell is left.
constexpr double not_reported = std::numeric_limits<double>::quiet_NaN();

void mark_place(const std::vector<char>& place, std::size_t watch, CellField& places) {
  for (std::size_t cell = 0; cell < place.size(); ++cell)
    places[cell] += place[cell] << watch;
}

bool was_in_place(const CellField& places, int cell, std::size_t watch) {
  return static_cast<int>(places[cell]) >> watch & 1;
}
}  // namespace

template <int dim>
WatchedPlaces<dim>::WatchedPlaces(const MacDomain<dim>& domain, std::vector<Watch<dim>> watches)
    : domain_(domain), watches_(std::move(watches)), places_(domain.grid.n_stored_cells(), 0.0) {
  check_input(watches_.size() <= most_watches, "\"Watch\" has {} places; it takes {}.",
              watches_.size(), most_watches);
}

template <int dim>
std::vector<int> WatchedPlaces<dim>::seeds(const Point<dim>& point, const SolidCells<dim>& solids,
                                           const NearbySurface<dim>& near) const {
  std::vector<int> found = cells_seen_from<dim>(point, domain_, near);
  found.erase(
      std::remove_if(found.begin(), found.end(), [&](int cell) { return !solids.is_fluid(cell); }),
      found.end());
  return found;
}

template <int dim>
void WatchedPlaces<dim>::begin(const Surface& surface) {
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  const NearbySurface<dim> near(present, domain_.grid, 2);
  const SolidCells<dim> solids = find_solid_cells<dim>(domain_, present);
  anchors_.clear();
  report_.assign(watches_.size(), {});
  places_.assign(places_.size(), 0);
  Mistakes mistakes;
  for (const Watch<dim>& watch : watches_)
    mistakes.collect([&] {
      const std::string name =
          fmt::format("point {:.6g} of the watch \"{}\"",
                      fmt::join(watch.point.data(), watch.point.data() + dim, ", "), watch.name);
      cells_seen_from_given<dim>(watch.point, name, domain_, near);
      anchors_.emplace_back(watch, present);
    });
  mistakes.throw_all();
  for (std::size_t w = 0; w < watches_.size(); ++w)
    mark_place(find_place(w, solids, near, nullptr), w, places_);
}

template <int dim>
std::vector<char> WatchedPlaces<dim>::find_place(std::size_t watch, const SolidCells<dim>& solids,
                                                 const NearbySurface<dim>& near,
                                                 const InterfaceStep<dim>* step) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Point<dim> point = anchors_[watch].place(solids.state.surface);
  const auto is_within = [&](int cell) {
    return way_between<dim>(domain_, point, grid.center(cell)).norm() < watches_[watch].radius;
  };
  std::vector<int> front = seeds(point, solids, near);
  if (step && sum_all(grid.comm(), static_cast<GlobalIndex>(front.size())) == 0) {
    const SweptCells<dim> swept(domain_, *step);
    grid.for_each_owned_cell([&](int cell) {
      if (was_in_place(places_, cell, watch) && solids.is_fluid(cell) && is_within(cell) &&
          !swept(cell))
        front.push_back(cell);
    });
  }
  std::vector<char> place(grid.n_stored_cells(), 0);
  for (const int cell : front)
    place[cell] = 1;
  const auto may_pass = [&](int cell, int other) {
    for (int side = 0; side < 2 * dim; ++side)
      if (grid.neighbor(cell, side / 2, side % 2) == other)
        return solids.seen_neighbor(grid, cell, side / 2, side % 2) >= 0 && is_within(other);
    return false;
  };
  flood(domain_, std::move(front), may_pass, place);
  return place;
}

template <int dim>
void WatchedPlaces<dim>::measure(const InterfaceStep<dim>& step,
                                 const InterfaceModel<dim>& interface) {
  const TiledGrid<dim>& grid = domain_.grid;
  const SolidCells<dim> solids = find_solid_cells<dim>(domain_, step.surface.after);
  const auto near = step.kept.of(solids.state.surface, grid, 2);
  CellField places(grid.n_stored_cells(), 0.0);
  for (std::size_t w = 0; w < watches_.size(); ++w) {
    const std::vector<char> place = find_place(w, solids, *near, &step);
    mark_place(place, w, places);
    const auto n_cells = std::count(place.begin(), place.begin() + grid.n_owned_cells(), 1);
    report_[w] = sum_all(grid.comm(), static_cast<GlobalIndex>(n_cells)) > 0
                     ? interface.liquid_in(place)
                     : WatchedLiquid{not_reported, not_reported};
  }
  places_ = std::move(places);
}

template class WatchedPlaces<2>;
template class WatchedPlaces<3>;

}  // namespace lockstep
