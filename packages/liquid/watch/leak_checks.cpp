// The part of LeakAudit that judges.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "liquid/watch/leak_audit.hpp"

namespace lockstep {

template <int dim>
void LeakAudit<dim>::explain_by_gaps(const InterfaceStep<dim>& step, std::vector<char> marked,
                                     int reach, std::vector<int>& cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const Surface after = step.surface.after ? step.surface.after : step.surface.before;
  if (!after || after->empty())
    return;
  constexpr char drop = 2;
  for (std::size_t cell = 0; cell < marked.size(); ++cell)
    if (before_.hidden[cell])
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
void LeakAudit<dim>::check_sides(const InterfaceStep<dim>& step, const Look& now) const {
  const auto is_empty = [](const auto& surface) { return !surface || surface->empty(); };
  if (is_empty(step.surface.before) || is_empty(step.surface.after))
    return;  // all ranks agree, also those without cells
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<int> leaked;
  grid.for_each_owned_cell([&](int cell) {
    const char freed = static_cast<char>(before_.occluded[cell] & ~now.occluded[cell]);
    if (!freed || now.cells[cell] != CellState::fluid || before_.cells[cell] != CellState::fluid)
      return;
    for (int axis = 0; axis < dim; ++axis) {
      const int other = grid.neighbor(cell, axis, 0);
      if (!(freed >> axis & 1) || other < 0 || now.cells[other] != CellState::fluid ||
          before_.cells[other] != CellState::fluid ||
          !(before_.watched[cell] | before_.watched[other]) ||
          !(before_.liquid[cell] || before_.liquid[other]))
        continue;
      const int solid = parting_solid(*step.surface.before, axis, cell);
      if (solid >= 0 && parting_solid(*step.surface.after, axis, cell) != solid &&
          !swept(step, cell) && !swept(step, other))
        leaked.push_back(cell);
    }
  });
  if (sum_all(grid.comm(), static_cast<GlobalIndex>(leaked.size())) > 0)
    complain(step, now, leaked);
}

template <int dim>
bool LeakAudit<dim>::stayed_closed(const InterfaceStep<dim>& step, const Look& now,
                                   std::size_t watch) const {
  const TiledGrid<dim>& grid = domain_.grid;
  // drops do not count as liquid, and fly freely
  bool open =
      has_drops_ || !step.sources.empty() || !step.sinks.empty() || watches_[watch].radius < 1e300;
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const SideType type = domain_.boundary.side(axis, end).type;
      open = open || type == SideType::open || type == SideType::inflow;
    }
  if (open)
    return false;
  GlobalIndex n_passed = 0;
  grid.for_each_owned_cell([&](int cell) {
    const bool changed = (before_.watched[cell] ^ now.watched[cell]) >> watch & 1;
    n_passed += changed && before_.cells[cell] == CellState::fluid &&
                now.cells[cell] == CellState::fluid && !swept(step, cell);
  });
  return sum_all(grid.comm(), n_passed) == 0;
}

template <int dim>
void LeakAudit<dim>::check_target(const InterfaceStep<dim>& step, std::size_t watch, double target,
                                  double lost) const {
  const double before = report_[watch].target;
  check_solve(std::abs(target - before) <= lost + 1e-9 * std::max(before, domain_.cell_volume()),
              "A leak: the closed watch \"{}\" should hold {:.9g} of liquid and, after the step at "
              "{:.6g} s, {:.9g}. This is an error of the program: please report it.",
              watches_[watch].name, before, step.time, target);
}

template <int dim>
void LeakAudit<dim>::complain(const InterfaceStep<dim>& step, const Look& now,
                              std::vector<int> cells) const {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<GlobalIndex> mine;
  for (const int cell : cells)
    mine.insert(mine.end(), {grid.global_id(cell), now.watched[cell] | before_.watched[cell]});
  std::vector<double> places;
  for (const int cell : cells) {
    const Point<dim> x = grid.center(cell);
    places.insert(places.end(), x.data(), x.data() + dim);
  }
  mine = gather_all(grid.comm(), mine);
  places = gather_all(grid.comm(), places);
  std::size_t first = 0;
  for (std::size_t i = 0; i < mine.size() / 2; ++i)
    if (mine[2 * i] < mine[2 * first])
      first = i;
  std::size_t watch = 0;
  while (watch + 1 < watches_.size() && !(mine[2 * first + 1] >> watch & 1))
    ++watch;
  const Point<dim> x = Eigen::Map<const Point<dim>>(&places[dim * first]);
  std::string through = "and no solid is near";
  const Surface surface = step.surface.after ? step.surface.after : step.surface.before;
  if (surface && !surface->empty())
    if (const auto nearest = surface->closest(x, 4 * grid.spacing()))
      through = fmt::format("nearest is \"{}\", simplex {}",
                            surface->solids()[surface->solid_of(nearest->simplex)].name,
                            nearest->simplex);
  throw SolveError(fmt::format(
      "A leak: in {} cells of the watch \"{}\", the first at {:.6g}, is liquid at {:.6g} s that no "
      "open way led to in the step; {}. If there is a gap narrower than an eighth of a cell, close "
      "it; else this is an error of the program: please report it.",
      mine.size() / 2, watches_[watch].name, fmt::join(x.data(), x.data() + dim, ", "),
      step.time + step.dt, through));
}

template void LeakAudit<2>::explain_by_gaps(const InterfaceStep<2>&, std::vector<char>, int,
                                            std::vector<int>&) const;
template bool LeakAudit<2>::gap_leads_to(int, const std::vector<char>&, const NearbySurface<2>&,
                                         int) const;
template int LeakAudit<2>::parting_solid(const SurfaceSnapshot<2>&, int, int) const;
template void LeakAudit<2>::check_sides(const InterfaceStep<2>&, const Look&) const;
template bool LeakAudit<2>::stayed_closed(const InterfaceStep<2>&, const Look&, std::size_t) const;
template void LeakAudit<2>::check_target(const InterfaceStep<2>&, std::size_t, double,
                                         double) const;
template void LeakAudit<2>::complain(const InterfaceStep<2>&, const Look&, std::vector<int>) const;
template void LeakAudit<3>::explain_by_gaps(const InterfaceStep<3>&, std::vector<char>, int,
                                            std::vector<int>&) const;
template bool LeakAudit<3>::gap_leads_to(int, const std::vector<char>&, const NearbySurface<3>&,
                                         int) const;
template int LeakAudit<3>::parting_solid(const SurfaceSnapshot<3>&, int, int) const;
template void LeakAudit<3>::check_sides(const InterfaceStep<3>&, const Look&) const;
template bool LeakAudit<3>::stayed_closed(const InterfaceStep<3>&, const Look&, std::size_t) const;
template void LeakAudit<3>::check_target(const InterfaceStep<3>&, std::size_t, double,
                                         double) const;
template void LeakAudit<3>::complain(const InterfaceStep<3>&, const Look&, std::vector<int>) const;

}  // namespace lockstep
