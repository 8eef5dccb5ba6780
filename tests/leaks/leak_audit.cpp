#include "leaks/leak_audit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "liquid/common/seen_cells.hpp"

namespace lockstep::test {

namespace {
template <int dim>
bool is_empty(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  return !surface || surface->empty();
}

void forget(const std::vector<char>& marked, std::vector<int>& cells) {
  cells.erase(std::remove_if(cells.begin(), cells.end(), [&](int cell) { return marked[cell]; }),
              cells.end());
}
}  // namespace

template <int dim>
void LeakAudit<dim>::judge(const InterfaceStep<dim>& step, const Look& now) {
  const Surface& surface = step.surface.before;
  for (std::size_t s = without_boundary_.size(); surface && s < surface->solids().size(); ++s)
    without_boundary_.push_back(is_closed<dim>(surface->mesh_of_solid(static_cast<int>(s))));
  const SweptCells<dim> swept(domain_, step);
  complain(step, find_from_nowhere(step, swept, now));
  complain(step, find_parted(step, swept, now));
}

template <int dim>
int LeakAudit<dim>::largest_displacement(const InterfaceStep<dim>& step,
                                         const SweptCells<dim>& swept) const {
  double fastest = 0;
  for (int axis = 0; axis < dim; ++axis)
    domain_.grid.for_each_owned_face(axis, [&](int cell) {
      fastest = std::max(fastest, std::abs(step.advection_velocity[axis][cell]));
    });
  const double farthest = std::max(max_all(domain_.grid.comm(), fastest) * step.dt, swept.motion());
  return static_cast<int>(farthest / domain_.spacing());
}

template <int dim>
std::vector<int> LeakAudit<dim>::find_from_nowhere(const InterfaceStep<dim>& step,
                                                   const SweptCells<dim>& swept,
                                                   const Look& now) const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<char> marked(grid.n_stored_cells(), 0);
  std::vector<int> passed_over;
  grid.for_each_owned_cell([&](int cell) {
    if (!before_.liquid.seen[cell])
      return;
    if (swept(cell))
      passed_over.push_back(cell);
    else
      marked[cell] = 1;
  });
  add_sources(step, marked);
  std::vector<int> cells;
  grid.for_each_owned_cell([&](int cell) {
    if (now.liquid.seen[cell] && !marked[cell])
      cells.push_back(cell);
  });
  // To a corner of where it has come from, and one more for corrections.
  const int reach = dim * (largest_displacement(step, swept) + 1) + 1;
  const std::vector<char> unspread = marked;
  explain(now, reach, marked, cells);
  if (sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) > 0) {
    marked = unspread;
    add_pushed(step, swept, passed_over, now, marked);
    const std::vector<char> pushed = marked;
    explain(now, reach, marked, cells);
    explain_swept(swept, now, marked, cells);
    if (sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) > 0)
      explain_by_gaps(step, pushed, reach / dim + 1, cells);
  }
  return cells;
}

template <int dim>
bool LeakAudit<dim>::sees_marked(const Look& now, const std::vector<char>& marked, int cell) const {
  for (int side = 0; side < 2 * dim; ++side) {
    const int other = now.solids.seen_neighbor(domain_.grid, cell, side / 2, side % 2);
    if (other >= 0 && marked[other])
      return true;
  }
  return false;
}

template <int dim>
void LeakAudit<dim>::explain(const Look& now, int reach, std::vector<char>& marked,
                             std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto is_done = [&] {
    forget(marked, cells);
    return sum_all(grid.comm(), static_cast<GlobalIndex>(cells.size())) == 0;
  };
  for (int layer = 0; layer < reach && !is_done(); ++layer) {
    domain_.halo.fill(marked);
    std::vector<int> next;
    grid.for_each_owned_cell([&](int cell) {
      if (!marked[cell] && now.solids.is_fluid(cell) && sees_marked(now, marked, cell))
        next.push_back(cell);
    });
    for (const int cell : next)
      marked[cell] = 1;
  }
  forget(marked, cells);
}

template <int dim>
void LeakAudit<dim>::explain_swept(const SweptCells<dim>& swept, const Look& now,
                                   std::vector<char>& marked, std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<int> waiting;
  grid.for_each_owned_cell([&](int cell) {
    if (!marked[cell] && now.solids.is_fluid(cell) && swept(cell))
      waiting.push_back(cell);
  });
  GlobalIndex n_new = 1;
  while (n_new > 0) {
    domain_.halo.fill(marked);
    const auto rest = std::partition(waiting.begin(), waiting.end(),
                                     [&](int cell) { return sees_marked(now, marked, cell); });
    n_new = rest - waiting.begin();
    for (auto cell = waiting.begin(); cell != rest; ++cell)
      marked[*cell] = 1;
    waiting.erase(waiting.begin(), rest);
    n_new = sum_all(grid.comm(), n_new);
  }
  forget(marked, cells);
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
void LeakAudit<dim>::add_pushed(const InterfaceStep<dim>& step, const SweptCells<dim>& swept,
                                const std::vector<int>& passed_over, const Look& now,
                                std::vector<char>& marked) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface after = step.surface.after ? step.surface.after : step.surface.before;
  if (is_empty(after))
    return;
  std::vector<double> mine;
  for (const int cell : passed_over) {
    const auto passage = swept(cell);
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
    for (const int cell :
         cells_seen_from<dim>(Eigen::Map<const Point<dim>>(&all[i]), domain_, *near))
      if (now.solids.is_fluid(cell))
        marked[cell] = 1;
}

template <int dim>
void LeakAudit<dim>::explain_by_gaps(const InterfaceStep<dim>& step, std::vector<char> marked,
                                     int reach, std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface after = step.surface.after ? step.surface.after : step.surface.before;
  if (is_empty(after))
    return;
  constexpr char drop = 2;
  for (std::size_t cell = 0; cell < marked.size(); ++cell)
    if (before_.liquid.hidden[cell])
      marked[cell] = drop;
  domain_.full_halo.fill(marked);
  const auto near = step.kept.of(after, grid, 2);
  cells.erase(std::remove_if(cells.begin(), cells.end(),
                             [&](int cell) { return gap_leads_to(cell, marked, *near, reach); }),
              cells.end());
}

/// Floods a finer lattice around the cell.
template <int dim>
bool LeakAudit<dim>::gap_leads_to(int cell, const std::vector<char>& marked, const Near& near,
                                  int reach) const {
  const TiledGrid<dim>& grid = domain_.grid;
  constexpr int finer = 8;
  const int width = 2 * reach * finer + 1;
  const double spacing = grid.spacing() / finer;
  const Point<dim> origin = grid.center(cell);
  Index<dim> middle;
  middle.fill(reach * finer);
  const auto place = [&](const Index<dim>& at) {
    int result = 0;
    for (int a = dim - 1; a >= 0; --a)
      result = result * width + at[a];
    return result;
  };
  const auto position = [&](const Index<dim>& at) {
    Point<dim> x = origin;
    for (int a = 0; a < dim; ++a)
      x[a] += spacing * (at[a] - middle[a]);
    return x;
  };
  std::vector<char> reached(static_cast<std::size_t>(std::pow(width, dim)), 0);
  std::vector<Index<dim>> front{middle};
  reached[place(middle)] = 1;
  while (!front.empty()) {
    const Index<dim> at = front.back();
    front.pop_back();
    const Point<dim> x = position(at);
    const int here = grid.cell_containing(x);
    if (here < 0 || !grid.in_domain(here))
      continue;
    const bool is_center = (x - grid.center(here)).norm() < 0.1 * spacing;
    if (marked[here] == 2 || (marked[here] == 1 && is_center && here != cell))
      return true;
    for (int side = 0; side < 2 * dim; ++side) {
      Index<dim> next = at;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (next[side / 2] < 0 || next[side / 2] >= width || reached[place(next)] ||
          near.first_hit(x, position(next)))
        continue;
      reached[place(next)] = 1;
      front.push_back(next);
    }
  }
  return false;
}

/// A solid without rim that lies between the centres of a cell and its lower neighbour, or -1.
template <int dim>
int LeakAudit<dim>::parting_solid(const SurfaceSnapshot<dim>& surface, int axis, int cell) const {
  const Lattice<dim> lattice = domain_.grid.lattice();
  Index<dim> here = domain_.grid.coordinates(cell), next = here, below = here;
  for (int& c : next)
    ++c;
  --below[axis];
  const double low = lattice.center(below)[axis], high = lattice.center(here)[axis];
  std::map<int, int> n_crossings;
  const LatticeCrossings<dim> crossings = surface.cross_lattice(lattice, here, next);
  for (const auto& line : crossings.lines[axis])
    for (const Crossing<dim>& crossing : line.crossings)
      if (crossing.coordinate > low && crossing.coordinate <= high)
        ++n_crossings[surface.solid_of(crossing.simplex)];
  for (const auto& [solid, n] : n_crossings)
    if (n % 2 == 1 && without_boundary_[solid])
      return solid;
  return -1;
}

template <int dim>
std::vector<int> LeakAudit<dim>::find_parted(const InterfaceStep<dim>& step,
                                             const SweptCells<dim>& swept, const Look& now) const {
  if (is_empty(step.surface.before) || is_empty(step.surface.after))
    return {};
  const TiledGrid<dim>& grid = domain_.grid;
  const auto is_fluid = [&](int cell) {
    return before_.solids.is_fluid(cell) && now.solids.is_fluid(cell);
  };
  std::vector<int> leaked;
  grid.for_each_owned_cell([&](int cell) {
    const char freed =
        static_cast<char>(before_.solids.occluded[cell] & ~now.solids.occluded[cell]);
    if (!freed || !is_fluid(cell))
      return;
    for (int axis = 0; axis < dim; ++axis) {
      const int other = grid.neighbor(cell, axis, 0);
      if (!(freed >> axis & 1) || other < 0 || !is_fluid(other) ||
          !(before_.liquid.seen[cell] || before_.liquid.seen[other]))
        continue;
      const int solid = parting_solid(*step.surface.before, axis, cell);
      if (solid >= 0 && parting_solid(*step.surface.after, axis, cell) != solid && !swept(cell) &&
          !swept(other))
        leaked.push_back(cell);
    }
  });
  return leaked;
}

template <int dim>
void LeakAudit<dim>::complain(const InterfaceStep<dim>& step, const std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<GlobalIndex> ids;
  std::vector<double> places;
  for (const int cell : cells) {
    const Point<dim> x = grid.center(cell);
    ids.push_back(grid.global_id(cell));
    places.insert(places.end(), x.data(), x.data() + dim);
  }
  ids = gather_all(grid.comm(), ids);
  places = gather_all(grid.comm(), places);
  if (ids.empty())
    return;
  const auto first = std::min_element(ids.begin(), ids.end()) - ids.begin();
  const Point<dim> x = Eigen::Map<const Point<dim>>(&places[dim * first]);
  std::string through = "no solid is near";
  const Surface surface = step.surface.after ? step.surface.after : step.surface.before;
  if (!is_empty(surface))
    if (const auto nearest = surface->closest(x, 4 * grid.spacing()))
      through = fmt::format("nearest is \"{}\", simplex {}",
                            surface->solids()[surface->solid_of(nearest->simplex)].name,
                            nearest->simplex);
  throw SolveError(fmt::format(
      "A leak: in {} cells, the first at {:.6g}, is liquid at {:.6g} s that no open "
      "way led to in the step; {}. A gap may be narrower than an eighth of a cell.",
      ids.size(), fmt::join(x.data(), x.data() + dim, ", "), step.time + step.dt, through));
}

template class LeakAudit<2>;
template class LeakAudit<3>;

}  // namespace lockstep::test
