#include "liquid/fractions/fraction_planes.hpp"

#include <algorithm>
#include <cmath>

#include "grid/flagged_tiles.hpp"

namespace lockstep {

namespace {
template <int dim>
constexpr int n_around = dim == 2 ? 9 : 27;

/// The offset of a neighbour along each axis, -1 to 1.
template <int dim>
Index<dim> offset_of(int neighbor) {
  Index<dim> offset;
  for (int a = 0; a < dim; ++a, neighbor /= 3)
    offset[a] = neighbor % 3 - 1;
  return offset;
}

/// A cell around another, and where it is from there.
template <int dim>
struct Around {
  int cell = -1;
  Index<dim> offset{};
};

/// The cells around one, each reached along the axes; where there is no way in sight, how far one
/// comes.
template <int dim>
std::array<Around<dim>, n_around<dim>> cells_around(const TiledGrid<dim>& grid,
                                                    const SolidCells<dim>& solids, int cell) {
  std::array<Around<dim>, n_around<dim>> result;
  const bool near = !solids.near.empty() && solids.near[cell];
  for (int k = 0; k < n_around<dim>; ++k) {
    const Index<dim> offset = offset_of<dim>(k);
    Around<dim>& found = result[k];
    found.cell = cell;
    for (int a = 0; a < dim; ++a) {
      if (offset[a] == 0)
        continue;
      const int side = offset[a] > 0 ? 1 : 0;
      const int next = near ? solids.seen_neighbor(grid, found.cell, a, side)
                            : grid.neighbor(found.cell, a, side);
      if (next < 0 || !grid.in_domain(next))
        continue;
      found.cell = next;
      found.offset[a] = offset[a];
    }
  }
  return result;
}

/// Weight of a neighbour in Youngs' gradient along `axis`.
template <int dim>
double youngs_weight(const Index<dim>& offset, int axis) {
  double weight = offset[axis];
  for (int a = 0; a < dim; ++a)
    weight *= a == axis || offset[a] != 0 ? 1 : 2;
  return weight;
}

/// True for a full cell beside an empty one, or the reverse, without a plane in either.
template <int dim>
bool is_beside_full_jump(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                         const CellField& fraction, int cell) {
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
    if (other >= 0 && !is_mixed(fraction[other]) &&
        (fraction[cell] > 0.5) != (fraction[other] > 0.5))
      return true;
  }
  return false;
}
}  // namespace

template <int dim>
Point<dim> FractionPlanes<dim>::normal(const SolidCells<dim>& solids, const CellField& fraction,
                                       int cell) const {
  const auto around = cells_around(domain_.grid, solids, cell);
  Point<dim> youngs = Point<dim>::Zero(), planes = Point<dim>::Zero();
  // Columns along h, their difference across t.
  std::array<std::array<double, dim>, dim> columns{};
  for (int k = 0; k < n_around<dim>; ++k) {
    const Index<dim> offset = offset_of<dim>(k);
    const double value = fraction[around[k].cell];
    for (int a = 0; a < dim; ++a) {
      youngs[a] -= youngs_weight<dim>(offset, a) * value;
      planes[a] -= offset[a] * value;
    }
    for (int h = 0; h < dim; ++h)
      for (int t = 0; t < dim; ++t) {
        bool is_in_plane = t != h;
        for (int a = 0; a < dim; ++a)
          is_in_plane = is_in_plane && (a == h || a == t || offset[a] == 0);
        columns[h][t] -= is_in_plane ? 0.5 * offset[t] * value : 0;
      }
  }
  Point<dim> best = Point<dim>::Zero();
  double steepest = 0;
  for (int h = 0; h < dim; ++h) {
    Point<dim> candidate;
    for (int t = 0; t < dim; ++t)
      candidate[t] = t == h ? (planes[h] > 0 ? 1 : -1) : columns[h][t];
    candidate /= candidate.template lpNorm<1>();
    if (std::abs(candidate[h]) > steepest) {
      steepest = std::abs(candidate[h]);
      best = candidate;
    }
  }
  const double sum = youngs.template lpNorm<1>();
  if (sum < 1e-12)
    return best;
  youngs /= sum;
  return steepest > youngs.template lpNorm<Eigen::Infinity>() ? youngs : best;
}

template <int dim>
void FractionPlanes<dim>::find(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                               const CellField& fraction) {
  for (CellField& number : numbers_)
    number.resize(fraction.size());
  for_each_owned_cell_of(domain_.grid, tiles, [&](int cell) {
    if (!is_mixed(fraction[cell]) || !solids.is_fluid(cell))
      return;
    const CellPlane<dim> plane =
        plane_of_fraction<dim>(normal(solids, fraction, cell), fraction[cell]);
    for (int a = 0; a < dim; ++a)
      numbers_[a][cell] = plane.normal[a];
    numbers_[dim][cell] = plane.constant;
  });
  std::vector<CellField*> fields;
  for (CellField& number : numbers_)
    fields.push_back(&number);
  domain_.halo.fill(fields);
}

template <int dim>
double FractionPlanes<dim>::distance_to(int cell, const Point<dim>& offset) const {
  const CellPlane<dim> plane = (*this)(cell);
  const double squares = plane.normal.squaredNorm();
  const double above = plane.normal.dot(offset) - plane.constant;
  Point<dim> foot = offset - above / squares * plane.normal;
  for (int a = 0; a < dim; ++a)
    foot[a] = std::clamp(foot[a], 0.0, 1.0);
  return std::max((offset - foot).norm(), std::abs(above) / std::sqrt(squares));
}

template <int dim>
void FractionPlanes<dim>::set_distance(const SolidCells<dim>& solids,
                                       const std::vector<char>& tiles, const CellField& fraction,
                                       double cut_off, CellField& phi) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const double h = domain_.spacing();
  const Point<dim> center = Point<dim>::Constant(0.5);
  for_each_owned_cell_of(grid, tiles, [&](int cell) {
    if (!solids.is_fluid(cell))
      return;
    double distance = cut_off / h;
    if (is_mixed(fraction[cell])) {
      distance = distance_to(cell, center);
    } else {
      for (const Around<dim>& other : cells_around(grid, solids, cell)) {
        Point<dim> place = center;
        for (int a = 0; a < dim; ++a)
          place[a] -= other.offset[a];
        if (is_mixed(fraction[other.cell]))
          distance = std::min(distance, distance_to(other.cell, place));
      }
      if (is_beside_full_jump(grid, solids, fraction, cell))
        distance = std::min(distance, 0.5);
    }
    // A centre on the surface is dry.
    phi[cell] = fraction[cell] > 0.5 ? -std::max(distance, 1e-12) * h : distance * h;
  });
  domain_.halo.fill(phi);
}

template class FractionPlanes<2>;
template class FractionPlanes<3>;

}  // namespace lockstep
