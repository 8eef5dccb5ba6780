#include "liquid/fractions/fraction_heights.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lockstep {

namespace {
/// Columns end in cells nearer than this to full or empty.
constexpr double negligible = 1e-6;
/// Least part of a normal along columns: of steeper ones the ends lie far apart.
constexpr double least_part = 0.5;
/// Slope beyond which the heights of columns say little of what is between them.
constexpr double steepest = 2;
/// Likewise, from one column to each of those around it.
constexpr double steepest_in_3d = 1.8;
/// Offsets, each beside one before it.
template <int dim>
constexpr std::array<int, 5> outwards = {0, 1, 2, -1, -2};
template <>
constexpr std::array<int, 7> outwards<2> = {0, 1, 2, 3, -1, -2, -3};
/// Weights of columns in a mean, by their distance: binomial.
template <int dim>
constexpr std::array<double, 2> weights = {2, 1};
template <>
constexpr std::array<double, 3> weights<2> = {6, 4, 1};
}  // namespace

template <int dim>
Point<dim> FractionHeights<dim>::slope(int cell) const {
  const TiledGrid<dim>& grid = domain_.grid;
  Point<dim> result;
  for (int a = 0; a < dim; ++a) {
    std::array<double, 2> beside{};
    int n_beside = 0;
    for (int end = 0; end < 2; ++end) {
      const int other = grid.neighbor(cell, a, end);
      const bool is_there = other >= 0 && grid.in_domain(other);
      beside[end] = phi_[is_there ? other : cell];
      n_beside += is_there;
    }
    result[a] = (beside[1] - beside[0]) / std::max(n_beside, 1);
  }
  return result;
}

template <int dim>
int FractionHeights<dim>::cell_of(Index<dim> place, int row, const Direction& direction) const {
  if (std::abs(row) > reach_along)
    return -1;
  place[direction.axis] += row * direction.outward;
  const int cell = domain_.grid.cell(place);
  const bool is_known = cell >= 0 && domain_.grid.in_domain(cell) && solids_.is_fluid(cell) &&
                        !solids_.near_surface(cell);
  return is_known ? cell : -1;
}

template <int dim>
typename FractionHeights<dim>::Column FractionHeights<dim>::follow(
    const Index<dim>& place, int row, const Direction& direction) const {
  double height = row;
  for (int r = row;; ++r) {
    const int cell = cell_of(place, r, direction);
    if (cell < 0)
      return {};
    height += fraction_[cell];
    if (fraction_[cell] < negligible)
      break;
  }
  const int first = cell_of(place, row, direction);
  double liquid = fraction_[first];
  for (int r = row - 1; liquid <= 1 - negligible; --r) {
    const int cell = cell_of(place, r, direction);
    if (cell < 0)
      return {};
    liquid = fraction_[cell];
    height += liquid - 1;
  }
  return {true, height, static_cast<int>(std::floor(height))};
}

template <int dim>
double FractionHeights<dim>::lead_of(const Index<dim>& place, const Column& column,
                                     const Direction& direction) const {
  const double lower = std::floor(column.height - 0.5), part = column.height - 0.5 - lower;
  const int below = cell_of(place, static_cast<int>(lower), direction);
  const int above = cell_of(place, static_cast<int>(lower) + 1, direction);
  if (below < 0 || above < 0)
    return 0;
  return ((1 - part) * lead_[below] + part * lead_[above]) / domain_.spacing();
}

/// Beyond a side of the domain columns are those before it, mirrored.
template <int dim>
typename FractionHeights<dim>::Column FractionHeights<dim>::column_beside(
    Index<dim> middle, const std::array<int, 2>& offset, int row,
    const Direction& direction) const {
  for (int i = 0, axis = 0; i < dim - 1; ++i, ++axis) {
    axis += axis == direction.axis;
    middle[axis] += offset[i];
    const int last = domain_.grid.n_cells()[axis] - 1;
    const int beyond = std::max(-middle[axis], middle[axis] - last);
    if (beyond <= 0 || domain_.boundary.periodic(axis))
      continue;
    const int end = middle[axis] < 0 ? 0 : 1;
    // The paraboloid knows contact angles.
    if (domain_.boundary.side(axis, end).contact_cotangent != 0)
      return {};
    middle[axis] = end == 0 ? -1 - middle[axis] : 2 * last + 1 - middle[axis];
  }
  Column column = follow(middle, row, direction);
  if (column.is_known)
    column.height -=
        std::sqrt(1 + direction.slope.squaredNorm()) * lead_of(middle, column, direction);
  return column;
}

template <int dim>
typename FractionHeights<dim>::Columns FractionHeights<dim>::columns_around(
    int cell, const Direction& direction) const {
  const Index<dim> middle = domain_.grid.coordinates(cell);
  Columns columns;
  for (int i = 0; i < n_columns; ++i) {
    const int a = outwards<dim>[i % width], b = outwards<dim>[i / width];
    const int before = b != 0 ? index(a, b - (b > 0 ? 1 : -1)) : index(a - (a > 0) + (a < 0), 0);
    if (i > 0 && !columns[before].is_known)
      continue;
    columns[index(a, b)] =
        column_beside(middle, {a, b}, i == 0 ? 0 : columns[before].row, direction);
  }
  return columns;
}

template <int dim>
std::optional<double> FractionHeights<dim>::bend(const Columns& columns, int a, int b) const {
  bool is_known = true;
  const auto height = [&](int i, int j) {
    const Column& column = columns[index(a + i, b + j)];
    is_known = is_known && column.is_known;
    return column.height;
  };
  const double x = 0.5 * (height(1, 0) - height(-1, 0));
  const double xx = height(1, 0) - 2 * height(0, 0) + height(-1, 0);
  if constexpr (dim == 2) {
    if (!is_known || std::abs(x) > steepest)
      return {};
    return -xx / std::pow(1 + x * x, 1.5);
  } else {
    const double y = 0.5 * (height(0, 1) - height(0, -1));
    const double yy = height(0, 1) - 2 * height(0, 0) + height(0, -1);
    const double xy = 0.25 * (height(1, 1) - height(1, -1) - height(-1, 1) + height(-1, -1));
    const double sum = (1 + y * y) * xx - 2 * x * y * xy + (1 + x * x) * yy;
    for (int k = 0; k < 9; ++k) {
      const int i = k % 3 - 1, j = k / 3 - 1;
      is_known =
          is_known && std::abs(height(i, j) - height(0, 0)) <= steepest_in_3d * std::hypot(i, j);
    }
    if (!is_known)
      return {};
    return -sum / std::pow(1 + x * x + y * y, 1.5);
  }
}

template <int dim>
std::optional<double> FractionHeights<dim>::mean_bend(int cell, const Direction& direction) const {
  const Columns columns = columns_around(cell, direction);
  if (!bend(columns, 0, 0))
    return {};
  double sum = 0, weight = 0;
  constexpr int across = dim == 2 ? 0 : reach_of_mean;
  for (int b = -across; b <= across; ++b)
    for (int a = -reach_of_mean; a <= reach_of_mean; ++a) {
      // Both sides or none, or what changes along the surface would count.
      const auto one = bend(columns, a, b), opposite = bend(columns, -a, -b);
      if (!one || !opposite)
        continue;
      const double part = weights<dim>[std::abs(a)] * weights<dim>[std::abs(b)];
      sum += part * *one;
      weight += part;
    }
  return sum / weight;
}

template <int dim>
std::optional<double> FractionHeights<dim>::curvature(int wet, int axis, int side,
                                                      double place) const {
  const int dry = domain_.grid.neighbor(wet, axis, side);
  const Point<dim> normal = (1 - place) * slope(wet) + place * slope(dry);
  std::array<int, dim> axes{};
  std::iota(axes.begin(), axes.end(), 0);
  std::sort(axes.begin(), axes.end(),
            [&](int a, int b) { return std::abs(normal[a]) > std::abs(normal[b]); });
  const double most = dim - 1, h = domain_.spacing();
  for (const int a : axes) {
    if (std::abs(normal[a]) <= least_part * normal.norm())
      break;
    Direction direction{a, normal[a] > 0 ? 1 : -1, -normal / normal[a]};
    direction.slope[a] = 0;
    auto kappa = mean_bend(wet, direction);
    if (a != axis) {
      // The surface crosses the line between the middles of two columns.
      const auto other = mean_bend(dry, direction);
      kappa = kappa && other ? (1 - place) * *kappa + place * *other : kappa ? kappa : other;
    }
    if (kappa)
      return std::clamp(*kappa, -most, most) / h;
  }
  return {};
}

template class FractionHeights<2>;
template class FractionHeights<3>;

}  // namespace lockstep
