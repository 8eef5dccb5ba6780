#include "staggered/state/cell_sides.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {

/// The lattice of the cells' corners, moved into the domain by some 1e-9 of a cell, by another part
/// along each axis: so no side or edge of a solid lies on a line, and what ends at a side of the
/// domain crosses the line there.
template <int dim>
Lattice<dim> lattice_of_corners(const TiledGrid<dim>& grid) {
  constexpr std::array<double, 3> part{0.5317, 0.5713, 0.4721};
  const double h = grid.spacing(), shrunk = 1e-9 * h;
  Lattice<dim> corners;
  corners.spacing = h - shrunk;
  for (int a = 0; a < dim; ++a)
    corners.lower[a] =
        grid.lower()[a] + part[a] * shrunk * grid.n_cells()[a] - 0.5 * corners.spacing;
  return corners;
}

constexpr std::uint32_t bit(int i) {
  return std::uint32_t{1} << i;
}

template <int dim>
constexpr std::uint32_t edge_bit(int axis, int corner) {
  return bit((axis + 1) * (1 << dim) + corner);
}

void join_corners(int a, int b, int* of_corner, int n) {
  const int kept = std::min(of_corner[a], of_corner[b]);
  const int gone = std::max(of_corner[a], of_corner[b]);
  std::replace(of_corner, of_corner + n, gone, kept);
}

}  // namespace

template <int dim>
CellSides<dim>::CellSides(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
                          const SurfaceMarks<dim>& marks, const std::vector<CellState>& cells)
    : domain_(domain),
      surface_(surface),
      marks_(marks),
      cells_(cells),
      lattice_(lattice_of_corners(domain.grid)),
      cuts_(domain.grid.n_stored_cells(), 0),
      side_(domain.grid.n_stored_cells(), static_cast<char>(bit(n_corners) - 1)) {
  const TiledGrid<dim>& grid = domain.grid;
  if (grid.n_tiles() > 0) {
    auto [begin, end] = stored_range(grid);
    for (int& last : end)
      ++last;
    const LatticeCrossings<dim> crossings = surface.cross_lattice(lattice_, begin, end);
    for (int axis = 0; axis < dim; ++axis)
      for (const Line& line : crossings.lines[axis])
        mark_line(axis, line);
  }
  grid.for_each_owned_cell([&](int cell) {
    if (marks.near[cell] && cells[cell] != CellState::outside)
      side_[cell] = static_cast<char>(side_of(cell));
  });
  domain.halo.fill(side_);
}

/// Marks the edges that a line crosses, and along axis 0 the corners between that are inside.
template <int dim>
void CellSides<dim>::mark_line(int axis, const Line& line) {
  const int n = domain_.grid.n_cells()[axis];
  std::vector<int> holders;  // closed solids that the line is in
  int from = 0;
  for (const Crossing<dim>& crossing : line.crossings) {
    const double place = (crossing.coordinate - lattice_.lower[axis]) / lattice_.spacing - 0.5;
    const int next = static_cast<int>(std::clamp(std::ceil(place), 0., n + 1.));
    Index<dim> corner = line.cell;
    corner[axis] = next - 1;
    if (next > 0 && next <= n)
      mark_around(corner, [axis](int c) { return c >> axis & 1 ? 0 : edge_bit<dim>(axis, c); });
    const int solid = surface_.solid_of(crossing.simplex);
    if (axis > 0 || !surface_.solids()[solid].closed)
      continue;
    for (; !holders.empty() && from < next; ++from) {
      corner[axis] = from;
      mark_around(corner, [](int c) { return bit(c); });
    }
    from = next;
    const auto found = std::find(holders.begin(), holders.end(), solid);
    if (found == holders.end())
      holders.push_back(solid);
    else
      holders.erase(found);
  }
}

/// Sets the bit that a corner of the lattice has in each cell around it; 0: none.
template <int dim>
template <typename Bit>
void CellSides<dim>::mark_around(const Index<dim>& corner, const Bit& bit_of) {
  for (int c = 0; c < n_corners; ++c) {
    Index<dim> place = corner;
    for (int a = 0; a < dim; ++a)
      place[a] -= c >> a & 1;
    if (!domain_.grid.in_domain(place))
      continue;
    if (const int cell = domain_.grid.cell(place); cell >= 0)
      cuts_[cell] |= bit_of(c);
  }
}

template <int dim>
Point<dim> CellSides<dim>::corner(int cell, int corner) const {
  Index<dim> place = domain_.grid.coordinates(cell);
  for (int a = 0; a < dim; ++a)
    place[a] += corner >> a & 1;
  return lattice_.center(place);
}

template <int dim>
bool CellSides<dim>::sees(int cell, int corner) const {
  return !surface_.first_hit(domain_.grid.center(cell), this->corner(cell, corner));
}

/// True if nothing crosses the edge that leads up from this corner. One in a side of the domain
/// does not count beside one that is crossed between two corners in the fluid: else what ends short
/// of a wall by less than a cell would leave a gap as wide as the cell.
template <int dim>
bool CellSides<dim>::is_uncut(int cell, const Index<dim>& place, int axis, int corner) const {
  const std::uint32_t cuts = cuts_[cell];
  if (cuts & edge_bit<dim>(axis, corner))
    return false;
  const GridDescription<dim>& grid = domain_.grid.description();
  bool is_at_side = false, counts = false;
  for (int a = 0; a < dim; ++a) {
    const bool is_upper = (corner >> a & 1) != 0;
    if (a == axis || grid.periodic[a] || place[a] != (is_upper ? grid.n_cells[a] - 1 : 0))
      continue;
    is_at_side = true;
    const int inward = corner ^ (1 << a);
    counts = counts || (cuts & edge_bit<dim>(axis, inward)) == 0 ||
             (cuts & (bit(inward) | bit(inward | 1 << axis))) != 0;
  }
  return !is_at_side || counts;
}

/// The component of each corner, named by its first one; -1 inside a solid.
template <int dim>
auto CellSides<dim>::components(int cell) const -> Components {
  const Index<dim> place = domain_.grid.coordinates(cell);
  Components of_corner;
  for (int c = 0; c < n_corners; ++c)
    of_corner[c] = cuts_[cell] & bit(c) ? -1 : c;
  for (int axis = 0; axis < dim; ++axis)
    for (int c = 0; c < n_corners; ++c) {
      const int other = c | 1 << axis;
      if (other != c && of_corner[c] >= 0 && of_corner[other] >= 0 &&
          is_uncut(cell, place, axis, c))
        join_corners(c, other, of_corner.data(), n_corners);
    }
  return of_corner;
}

/// Joins what is joined in a cell beside this one: there a thick solid bulges a little over an
/// edge.
template <int dim>
void CellSides<dim>::join_around(int cell, Components& of_corner) const {
  const Index<dim> place = domain_.grid.coordinates(cell);
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      Index<dim> beside = place;
      beside[axis] += 2 * end - 1;
      const int other = domain_.grid.in_domain(beside) ? domain_.grid.cell(beside) : -1;
      if (other < 0)
        continue;
      const Components there = components(other);
      const int flip = 1 << axis;
      for (int c = 0; c < n_corners; ++c)
        for (int d = 0; d < c; ++d)
          if ((c >> axis & 1) == end && (d >> axis & 1) == end && of_corner[c] >= 0 &&
              of_corner[d] >= 0 && there[c ^ flip] == there[d ^ flip])
            join_corners(c, d, of_corner.data(), n_corners);
    }
}

/// The corners of the side of a cell, as bits.
template <int dim>
int CellSides<dim>::side_of(int cell) const {
  Components of_corner = components(cell);
  const auto is_one = [&] {
    int first = -1;
    for (const int component : of_corner) {
      if (component >= 0 && first >= 0 && component != first)
        return false;
      first = std::max(first, component);
    }
    return true;
  };
  if (!is_one() && std::count(of_corner.begin(), of_corner.end(), -1) > 0)
    join_around(cell, of_corner);
  int chosen = -1;
  if (is_one()) {
    chosen = *std::max_element(of_corner.begin(), of_corner.end());
  } else if (cells_[cell] == CellState::fluid) {
    for (int c = 0; c < n_corners; ++c) {
      if (of_corner[c] < 0 || of_corner[c] == chosen || !sees(cell, c))
        continue;
      if (chosen >= 0)
        join_corners(of_corner[c], chosen, of_corner.data(), n_corners);
      chosen = of_corner[c];
    }
  } else {
    std::array<int, n_corners> n{};
    for (const int component : of_corner)
      if (component >= 0)
        ++n[component];
    const auto most = std::max_element(n.begin(), n.end());
    if (std::count(n.begin(), n.end(), *most) == 1)
      chosen = static_cast<int>(most - n.begin());
  }
  int side = 0;
  for (int c = 0; c < n_corners; ++c)
    if (of_corner[c] >= 0 && of_corner[c] == chosen)
      side |= 1 << c;
  return side;
}

template <int dim>
bool CellSides<dim>::center_is_on_side(int cell) const {
  if (cells_[cell] != CellState::fluid)
    return false;
  for (int c = 0; c < n_corners; ++c)
    if ((side_[cell] >> c & 1) != 0 && sees(cell, c))
      return true;
  return side_[cell] == 0;
}

template <int dim>
bool CellSides<dim>::joined(int axis, int cell) const {
  const FaceCells face = cells_of_face(domain_.grid, cells_, axis, cell);
  constexpr int all = (1 << n_corners) - 1;
  const int of_lower = face.lower < 0 ? all : static_cast<unsigned char>(side_[face.lower]);
  const int of_upper = face.upper < 0 ? all : static_cast<unsigned char>(side_[face.upper]);
  const int shared = of_upper & of_lower >> (1 << axis);
  for (int c = 0; c < n_corners; ++c)
    if ((c >> axis & 1) == 0 && (shared >> c & 1) != 0)
      return true;
  return (marks_.occluded[cell] >> axis & 1) == 0 &&
         (face.lower < 0 || center_is_on_side(face.lower)) &&
         (face.upper < 0 || center_is_on_side(face.upper));
}

template class CellSides<2>;
template class CellSides<3>;

}  // namespace lockstep
