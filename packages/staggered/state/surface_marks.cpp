#include "staggered/state/surface_marks.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// The cell whose centre is the first at or above a coordinate: the crossing lies in the segment
/// from the centre before to this one, its end included.
int cell_above(double coordinate, double lower, double spacing) {
  const auto center = [&](int i) { return lower + (i + 0.5) * spacing; };
  const double estimate = std::ceil((coordinate - lower) / spacing - 0.5);
  int i = static_cast<int>(std::min(std::max(estimate, -1e9), 1e9));
  while (center(i) < coordinate)
    ++i;
  while (center(i - 1) >= coordinate)
    --i;
  return i;
}

template <int dim>
void mark_occluded(const MacDomain<dim>& domain, int axis,
                   const typename LatticeCrossings<dim>::Line& line, std::vector<char>& occluded) {
  const TiledGrid<dim>& grid = domain.grid;
  const double lower = grid.lower()[axis], h = grid.spacing();
  const int n = grid.n_cells()[axis];
  for (const Crossing<dim>& crossing : line.crossings) {
    if (crossing.coordinate < lower - h || crossing.coordinate > lower + (n + 1) * h)
      continue;
    Index<dim> coordinates = line.cell;
    coordinates[axis] = cell_above(crossing.coordinate, lower, h);
    // A crossing beyond a periodic side must not wrap round to faces inside the domain.
    if (coordinates[axis] < 0 || coordinates[axis] > n)
      continue;
    // Beyond the last centre, only the half segment to a side is inside the domain.
    if (!grid.description().periodic[axis] &&
        (crossing.coordinate < lower || crossing.coordinate > lower + n * h))
      continue;
    const int cell = grid.cell(coordinates);
    if (cell >= 0)
      occluded[cell] = static_cast<char>(occluded[cell] | (1 << axis));
  }
}

/// Fills the stretches of a line along axis 0 that are inside some closed solid.
template <int dim>
void fill_solid(const TiledGrid<dim>& grid, const SurfaceSnapshot<dim>& surface,
                const typename LatticeCrossings<dim>::Line& line, int begin, int end,
                std::vector<CellState>& cells) {
  std::vector<int> open_solids;
  int from = begin;
  for (const Crossing<dim>& crossing : line.crossings) {
    const int solid = surface.solid_of(crossing.simplex);
    if (!surface.solids()[solid].closed)
      continue;
    const double clamped =
        std::min(std::max(crossing.coordinate, grid.lower()[0] + (begin - 1) * grid.spacing()),
                 grid.lower()[0] + (end + 1) * grid.spacing());
    const int here =
        std::min(std::max(cell_above(clamped, grid.lower()[0], grid.spacing()), begin), end);
    for (Index<dim> c = line.cell; !open_solids.empty() && from < here; ++from) {
      c[0] = from;
      const int cell = grid.cell(c);
      if (cell >= 0)
        cells[cell] = CellState::solid;
    }
    from = here;
    const auto found = std::find(open_solids.begin(), open_solids.end(), solid);
    if (found == open_solids.end())
      open_solids.push_back(solid);
    else
      open_solids.erase(found);
  }
}

template <int dim, typename Function>
void for_each_index(const Index<dim>& begin, const Index<dim>& end, const Function& f) {
  for (int a = 0; a < dim; ++a)
    if (begin[a] >= end[a])
      return;
  Index<dim> c = begin;
  while (true) {
    f(c);
    int a = 0;
    while (a < dim && ++c[a] == end[a])
      c[a] = begin[a], ++a;
    if (a == dim)
      return;
  }
}

/// A box of cells.
template <int dim>
struct Cells {
  Index<dim> begin{}, end{};
};

/// Marks cells that, grown by h/2, touch both the bounds and the plane of a simplex. `stored`: a
/// box of cells that holds all of this rank; `marked`: one of cells that are marked already, in a
/// fine mesh often those of the next simplex too.
template <int dim>
void mark_near(const TiledGrid<dim>& grid, const SurfaceSnapshot<dim>& surface, int simplex,
               const Cells<dim>& stored, Cells<dim>& marked, std::vector<char>& near) {
  const auto& [begin, end] = stored;
  const double h = grid.spacing();
  const Box<dim> bounds = surface.bounds(simplex);
  Index<dim> first{}, last{};
  for (int a = 0; a < dim; ++a) {
    // Periodic images one cell beyond the domain are reached by the wrap below.
    const int slack = grid.description().periodic[a] ? 1 : 0;
    const double low = (bounds.min()[a] - grid.lower()[a]) / h - 0.51;
    const double high = (bounds.max()[a] - grid.lower()[a]) / h + 0.51;
    // The layer of faces above the domain belongs to the coordinate n.
    first[a] = static_cast<int>(std::floor(std::max(low, begin[a] - 2.0)));
    last[a] = static_cast<int>(std::floor(std::min(high, end[a] + 2.0))) + 1;
    first[a] = std::max(first[a], begin[a] - slack);
    last[a] = std::min(last[a], end[a] + 1);
  }
  if (first == marked.begin && last == marked.end)
    return;
  marked = {first, last};
  const auto corners = surface.corners(simplex);
  const Point<dim> normal = area_vector<dim>(corners);
  const double reach = 1.02 * h * normal.template lpNorm<1>();
  const Lattice<dim> lattice = grid.lattice();
  for_each_index<dim>(first, last, [&](const Index<dim>& c) {
    if (std::abs(normal.dot(lattice.center(c) - corners[0])) > reach) {
      marked = {};
      return;
    }
    const int cell = grid.cell(c);
    if (cell >= 0)
      near[cell] = 1;
  });
}
}  // namespace

template <int dim>
std::array<Index<dim>, 2> stored_range(const TiledGrid<dim>& grid) {
  Index<dim> begin = grid.n_cells(), end{};
  for (int tile = 0; tile < grid.n_tiles(); ++tile)
    for (int a = 0; a < dim; ++a) {
      const int first = grid.tile_begin(tile)[a];
      begin[a] = std::min(begin[a], first);
      end[a] = std::max(end[a], std::min(first + tile_width<dim>, grid.n_cells()[a]));
    }
  return {begin, end};
}

template <int dim>
SurfaceMarks<dim> mark_surface(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
                               std::vector<CellState>& cells) {
  const TiledGrid<dim>& grid = domain.grid;
  SurfaceMarks<dim> marks;
  marks.occluded.assign(grid.n_stored_cells(), 0);
  marks.near.assign(grid.n_stored_cells(), 0);
  if (grid.n_tiles() == 0)
    return marks;
  const auto [begin, end] = stored_range(grid);
  const LatticeCrossings<dim> crossings = surface.cross_lattice(grid.lattice(), begin, end);
  for (const auto& line : crossings.lines[0])
    fill_solid(grid, surface, line, begin[0], end[0], cells);
  for (int axis = 0; axis < dim; ++axis)
    for (const auto& line : crossings.lines[axis])
      mark_occluded(domain, axis, line, marks.occluded);
  Cells<dim> marked;
  for (int s = 0; s < surface.n_simplices(); ++s)
    mark_near<dim>(grid, surface, s, {begin, end}, marked, marks.near);
  return marks;
}

template std::array<Index<2>, 2> stored_range<2>(const TiledGrid<2>&);
template std::array<Index<3>, 2> stored_range<3>(const TiledGrid<3>&);
template SurfaceMarks<2> mark_surface<2>(const MacDomain<2>&, const SurfaceSnapshot<2>&,
                                         std::vector<CellState>&);
template SurfaceMarks<3> mark_surface<3>(const MacDomain<3>&, const SurfaceSnapshot<3>&,
                                         std::vector<CellState>&);

}  // namespace lockstep
