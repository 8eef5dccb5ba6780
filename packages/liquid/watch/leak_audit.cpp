#include "liquid/watch/leak_audit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "liquid/common/flood.hpp"
#include "liquid/common/seen_cells.hpp"
#include "staggered/state/surface_marks.hpp"
#include "transport/largest_move.hpp"

namespace lockstep {

namespace {
constexpr int most_watches = 30;
/// Reported value of a place of which no cell is left.
constexpr double not_reported = std::numeric_limits<double>::quiet_NaN();
constexpr WatchedLiquid not_watched{not_reported, not_reported, not_reported};

bool is_watched(const WatchedLiquid& liquid) {
  return !std::isnan(liquid.volume);
}
}  // namespace

template <int dim>
LeakAudit<dim>::LeakAudit(const MacDomain<dim>& domain, std::vector<Watch<dim>> watches)
    : domain_(domain), watches_(std::move(watches)), places_(domain.grid.n_stored_cells(), 0.0) {
  check_input(watches_.size() <= most_watches, "\"Watch\" has {} places; it takes {}.",
              watches_.size(), most_watches);
}

/// Cells of the fluid whose centres the point sees, of those around it.
template <int dim>
std::vector<int> LeakAudit<dim>::seeds(const Point<dim>& point, const std::vector<CellState>& cells,
                                       const Near& near) const {
  std::vector<int> found = cells_seen_from<dim>(point, domain_, near);
  const auto holds_no_fluid = [&](int cell) { return cells[cell] != CellState::fluid; };
  found.erase(std::remove_if(found.begin(), found.end(), holds_no_fluid), found.end());
  return found;
}

template <int dim>
void LeakAudit<dim>::begin(const Surface& surface) {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  without_boundary_.clear();
  for (std::size_t s = 0; present && s < present->solids().size(); ++s)
    without_boundary_.push_back(is_closed<dim>(present->mesh_of_solid(static_cast<int>(s))));
  const Near near(present, grid, 2);
  std::vector<CellState> cells(grid.n_stored_cells(), CellState::outside);
  grid.for_each_stored_cell([&](int cell) { cells[cell] = CellState::fluid; });
  if (present)
    mark_surface(domain_, *present, cells);
  anchors_.clear();
  has_report_ = false;
  report_.clear();
  for (const Watch<dim>& watch : watches_) {
    const std::string& name = watch.name;
    const std::string x =
        fmt::format("{:.6g}", fmt::join(watch.point.data(), watch.point.data() + dim, ", "));
    const int cell = grid.cell_containing(watch.point);
    const bool here = cell >= 0 && grid.owned(cell) && grid.in_domain(cell);
    check_input(sum_all(grid.comm(), static_cast<GlobalIndex>(here)) > 0,
                "The point {} of the watch \"{}\" lies outside of the domain.", x, name);
    check_input(!present || present->inside(watch.point) < 0,
                "The point {} of the watch \"{}\" lies inside a solid.", x, name);
    const auto n_seeds = static_cast<GlobalIndex>(seeds(watch.point, cells, near).size());
    check_input(sum_all(grid.comm(), n_seeds) > 0,
                "The point {} of the watch \"{}\" sees no centre of a cell; move it away from the "
                "solids, or take smaller cells.",
                x, name);
    anchors_.emplace_back(watch, present);
    report_.push_back({});
    holds_solids_.push_back(1);
  }
}

template <int dim>
bool LeakAudit<dim>::sees(const Look& look, int cell, int axis, int side) const {
  const int other = domain_.grid.neighbor(cell, axis, side);
  if (other < 0 || look.cells[other] != CellState::fluid)
    return false;
  return look.occluded.empty() || !(look.occluded[side == 0 ? cell : other] >> axis & 1);
}

template <int dim>
typename LeakAudit<dim>::Look LeakAudit<dim>::look(const Surface& surface,
                                                   InterfaceModel<dim>& interface,
                                                   KeptSurface<dim>& kept,
                                                   const StaysInPlace& stays) {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface present = surface && !surface->empty() ? surface : nullptr;
  Look result;
  result.surface = present;
  result.cells.assign(grid.n_stored_cells(), CellState::outside);
  grid.for_each_stored_cell([&](int cell) { result.cells[cell] = CellState::fluid; });
  if (present)
    result.occluded = mark_surface(domain_, *present, result.cells).occluded;
  LiquidCells liquid = interface.cells_with_liquid(present, kept);
  result.liquid = std::move(liquid.seen);
  result.hidden = std::move(liquid.hidden);
  result.watched.assign(grid.n_stored_cells(), 0);
  const auto near = kept.of(present, grid, 2);
  for (std::size_t w = 0; w < watches_.size(); ++w) {
    const std::vector<char> place = find_place(w, result, *near, stays);
    for (std::size_t cell = 0; cell < place.size(); ++cell)
      result.watched[cell] |= place[cell] << w;
  }
  places_.assign(result.watched.begin(), result.watched.end());
  return result;
}

template <int dim>
std::vector<char> LeakAudit<dim>::find_place(std::size_t watch, const Look& now, const Near& near,
                                             const StaysInPlace& stays) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Point<dim> point = anchors_[watch].place(now.surface);
  const auto is_within = [&](int cell) {
    return way_between<dim>(domain_, point, grid.center(cell)).norm() < watches_[watch].radius;
  };
  std::vector<int> front = seeds(point, now.cells, near);
  if (sum_all(grid.comm(), static_cast<GlobalIndex>(front.size())) == 0)
    grid.for_each_owned_cell([&](int cell) {
      const bool was_there = static_cast<int>(places_[cell]) >> watch & 1;
      if (was_there && now.cells[cell] == CellState::fluid && is_within(cell) && stays(cell))
        front.push_back(cell);
    });
  std::vector<char> place(grid.n_stored_cells(), 0);
  for (const int cell : front)
    place[cell] = 1;
  const auto may_pass = [&](int cell, int other) {
    for (int side = 0; side < 2 * dim; ++side)
      if (grid.neighbor(cell, side / 2, side % 2) == other)
        return sees(now, cell, side / 2, side % 2) && is_within(other);
    return false;
  };
  flood(domain_, std::move(front), may_pass, place);
  return place;
}

template <int dim>
void LeakAudit<dim>::open(const InterfaceStep<dim>& step, InterfaceModel<dim>& interface) {
  const Surface& present = step.surface.before;
  if (last_ && last_->surface == (present && !present->empty() ? present : nullptr))
    before_ = std::move(*last_);
  else
    before_ = look(present, interface, step.kept, [](int) { return true; });
  last_.reset();
  motion_ = largest_move(step.surface);
  const double reach = motion_ / domain_.spacing() + 2;
  near_before_ = step.kept.of(before_.surface, domain_.grid,
                              static_cast<int>(std::min<double>(reach, Near::longest_reach)));
  lost_ = interface.ledger().lost;
  has_drops_ = interface.drops();
}

template <int dim>
bool LeakAudit<dim>::holds_solids(const Look& now, const std::vector<char>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  GlobalIndex n_beside = 0;
  grid.for_each_owned_cell([&](int cell) {
    if (!cells[cell] || now.cells[cell] != CellState::fluid)
      return;
    for (int side = 0; side < 2 * dim; ++side) {
      const int other = grid.neighbor(cell, side / 2, side % 2);
      n_beside += other >= 0 && now.cells[other] == CellState::solid;
    }
  });
  return sum_all(grid.comm(), n_beside) > 0;
}

template <int dim>
void LeakAudit<dim>::close(const InterfaceStep<dim>& step, InterfaceModel<dim>& interface,
                           double displacement) {
  const TiledGrid<dim>& grid = domain_.grid;
  Look now =
      look(step.surface.after, interface, step.kept, [&](int cell) { return !swept(step, cell); });
  const std::vector<int> leaked = find_from_nowhere(step, now, displacement);
  if (sum_all(grid.comm(), static_cast<GlobalIndex>(leaked.size())) > 0)
    complain(step, now, leaked);
  check_sides(step, now);
  for (std::size_t w = 0; w < watches_.size(); ++w) {
    std::vector<char> cells(grid.n_stored_cells(), 0);
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      cells[cell] = now.watched[cell] >> w & 1;
    const bool held_solids = holds_solids_[w];
    holds_solids_[w] = holds_solids(now, cells);
    const auto n_watched = static_cast<GlobalIndex>(
        std::count(cells.begin(), cells.begin() + grid.n_owned_cells(), 1));
    const WatchedLiquid liquid =
        sum_all(grid.comm(), n_watched) > 0 ? interface.liquid_in(cells) : not_watched;
    if (has_report_ && is_watched(report_[w]) && is_watched(liquid) && !held_solids &&
        !holds_solids_[w] && stayed_closed(step, now, w))
      check_target(step, w, liquid.target, interface.ledger().lost - lost_);
    report_[w] = liquid;
  }
  has_report_ = true;
  last_ = std::move(now);
  near_before_.reset();
}

template <int dim>
std::optional<SurfacePoint<dim>> LeakAudit<dim>::swept(const InterfaceStep<dim>& step,
                                                       int cell) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Near& near = *near_before_;
  if (near.empty() ||
      near.cells_to(grid.coordinates(cell)) * grid.spacing() > motion_ + grid.spacing())
    return {};
  const Point<dim> x = grid.center(cell);
  const auto& before = *step.surface.before;
  const auto& after = step.surface.after ? *step.surface.after : before;
  for (const SurfaceSnapshot<dim>* surface : {&before, &after})
    if (auto touched = surface->closest(x, 2 * near.tolerance()))
      return touched;
  if (motion_ == 0)
    return {};
  std::vector<int> candidates;
  const Point<dim> reach = Point<dim>::Constant(motion_);
  before.touching(Box<dim>(x - reach, x + reach), candidates);
  return swept_over<dim>(before, after, x, candidates);
}

template <int dim>
std::vector<int> LeakAudit<dim>::find_from_nowhere(const InterfaceStep<dim>& step, const Look& now,
                                                   double displacement) {
  const TiledGrid<dim>& grid = domain_.grid;
  const double h = grid.spacing();
  std::vector<char> marked(grid.n_stored_cells(), 0);
  std::vector<int> passed_over;
  grid.for_each_owned_cell([&](int cell) {
    if (!before_.liquid[cell])
      return;
    if (swept(step, cell))
      passed_over.push_back(cell);
    else
      marked[cell] = 1;
  });
  add_sources(step, marked);
  std::vector<int> cells;
  grid.for_each_owned_cell([&](int cell) {
    if (now.liquid[cell] && now.watched[cell] && !marked[cell])
      cells.push_back(cell);
  });
  // To a corner of where it has come from, and one more for corrections.
  const int reach = dim * (static_cast<int>(std::max(displacement, motion_ / h)) + 1) + 1;
  const std::vector<char> unspread = marked;
  explain(now, reach, marked, cells);
  if (sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) > 0) {
    marked = unspread;
    add_pushed(step, passed_over, now, marked);
    const std::vector<char> pushed = marked;
    explain(now, reach, marked, cells);
    explain_swept(step, now, marked, cells);
    if (sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) > 0)
      explain_by_gaps(step, pushed, reach / dim + 1, cells);
  }
  return cells;
}

template <int dim>
void LeakAudit<dim>::explain(const Look& now, int reach, std::vector<char>& marked,
                             std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto forget_explained = [&] {
    cells.erase(std::remove_if(cells.begin(), cells.end(), [&](int cell) { return marked[cell]; }),
                cells.end());
    return sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) == 0;
  };
  for (int layer = 0; layer < reach && !forget_explained(); ++layer) {
    domain_.halo.fill(marked);
    std::vector<int> next;
    grid.for_each_owned_cell([&](int cell) {
      if (marked[cell] || now.cells[cell] != CellState::fluid)
        return;
      for (int side = 0; side < 2 * dim; ++side)
        if (sees(now, cell, side / 2, side % 2) &&
            marked[grid.neighbor(cell, side / 2, side % 2)]) {
          next.push_back(cell);
          return;
        }
    });
    for (const int cell : next)
      marked[cell] = 1;
  }
  forget_explained();
}

template <int dim>
void LeakAudit<dim>::explain_swept(const InterfaceStep<dim>& step, const Look& now,
                                   std::vector<char>& marked, std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<int> waiting;
  grid.for_each_owned_cell([&](int cell) {
    if (!marked[cell] && now.cells[cell] == CellState::fluid && swept(step, cell))
      waiting.push_back(cell);
  });
  const auto sees_marked = [&](int cell) {
    for (int side = 0; side < 2 * dim; ++side)
      if (sees(now, cell, side / 2, side % 2) && marked[grid.neighbor(cell, side / 2, side % 2)])
        return true;
    return false;
  };
  GlobalIndex n_new = 1;
  while (n_new > 0) {
    domain_.halo.fill(marked);
    const auto rest = std::partition(waiting.begin(), waiting.end(), sees_marked);
    n_new = rest - waiting.begin();
    for (auto cell = waiting.begin(); cell != rest; ++cell)
      marked[*cell] = 1;
    waiting.erase(waiting.begin(), rest);
    n_new = sum_all(grid.comm(), n_new);
  }
  cells.erase(std::remove_if(cells.begin(), cells.end(), [&](int cell) { return marked[cell]; }),
              cells.end());
}

template <int dim>
void LeakAudit<dim>::add_sources(const InterfaceStep<dim>& step, std::vector<char>& marked) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const double h = grid.spacing();
  bool has_inflow = false;
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      has_inflow = has_inflow || domain_.boundary.side(axis, end).type == SideType::inflow;
  if (step.sources.empty() && !has_inflow)
    return;
  grid.for_each_owned_cell([&](int cell) {
    const Point<dim> x = grid.center(cell);
    for (const SignedDistance<dim>& source : step.sources)
      if (source(x) < h)
        marked[cell] = 1;
    const Index<dim> place = grid.coordinates(cell);
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end)
        if (place[axis] == (end == 0 ? 0 : grid.n_cells()[axis] - 1) &&
            domain_.boundary.side(axis, end).type == SideType::inflow)
          marked[cell] = 1;
  });
}

template <int dim>
void LeakAudit<dim>::add_pushed(const InterfaceStep<dim>& step, const std::vector<int>& passed_over,
                                const Look& now, std::vector<char>& marked) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface after = step.surface.after ? step.surface.after : step.surface.before;
  if (!after || after->empty())
    return;
  std::vector<double> mine;
  for (const int cell : passed_over) {
    const auto passage = swept(step, cell);
    if (!passage)
      continue;
    const auto from = step.surface.before->corners(passage->simplex);
    const auto to = after->corners(passage->simplex);
    Point<dim> start = Point<dim>::Zero(), end = start;
    for (int k = 0; k < dim; ++k) {
      start += passage->barycentric[k] * from[k];
      end += passage->barycentric[k] * to[k];
    }
    const double side = area_vector<dim>(from).dot(grid.center(cell) - start) < 0 ? -1 : 1;
    const Point<dim> x = end + 1e-3 * side * grid.spacing() * area_vector<dim>(to).normalized();
    mine.insert(mine.end(), x.data(), x.data() + dim);
  }
  const std::vector<double> all = gather_all(grid.comm(), mine);
  const auto near = step.kept.of(after, grid, 2);
  for (std::size_t i = 0; i < all.size(); i += dim)
    for (const int cell : seeds(Eigen::Map<const Point<dim>>(&all[i]), now.cells, *near))
      marked[cell] = 1;
}

template class LeakAudit<2>;
template class LeakAudit<3>;

}  // namespace lockstep
