#include "geometry/solid_volume.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "geometry/convex_part.hpp"

namespace lockstep {

namespace {

/// A box and the column that leaves it along `axis` towards `side` (+1 up, -1 down).
template <int dim>
struct Column {
  Box<dim> box;
  int axis = 0;
  int side = 1;
  /// The side of the box at the root of the column, and the one the column leaves through.
  double root() const { return side > 0 ? box.min()[axis] : box.max()[axis]; }
  double exit() const { return side > 0 ? box.max()[axis] : box.min()[axis]; }
};

/// The integrals of n_axis dA and of n_axis (x_axis - offset) dA over a part of a simplex.
struct Flux {
  double area = 0, moment = 0;
};
template <int dim>
Flux flux_through(const ConvexPart<dim, false>& part, int axis, double offset) {
  Flux flux;
  for (int i = 1; i + dim - 2 < part.n_vertices(); ++i) {
    std::array<Point<dim>, dim> points;
    double height = 0;
    for (int k = 0; k < dim; ++k) {
      points[k] = part.position(k == 0 ? 0 : i + k - 1);
      height += (points[k][axis] - offset) / dim;
    }
    const double area = area_vector<dim>(points)[axis];
    flux.area += area;
    flux.moment += area * height;
  }
  return flux;
}

/// The integral below of a simplex of which the column cuts nothing off, as of most of a fine mesh;
/// none if it does or the exit cuts it.
template <int dim>
std::optional<double> whole_flux(const std::array<Point<dim>, dim>& corners,
                                 const Column<dim>& column) {
  Point<dim> lower = corners[0], upper = corners[0], sum = corners[0];
  for (int k = 1; k < dim; ++k) {
    lower = lower.cwiseMin(corners[k]);
    upper = upper.cwiseMax(corners[k]);
    sum += corners[k];
  }
  const int axis = column.axis;
  for (int a = 0; a < dim; ++a)
    if (a != axis && (lower[a] < column.box.min()[a] || upper[a] > column.box.max()[a]))
      return std::nullopt;
  const double area = area_vector<dim>(corners)[axis];
  if (column.side > 0 ? lower[axis] > column.exit() : upper[axis] < column.exit())
    return area * (column.exit() - column.root());
  if (column.box.min()[axis] <= lower[axis] && upper[axis] <= column.box.max()[axis])
    return area * (sum[axis] / dim - column.root());
  return std::nullopt;
}

/// The integral over a simplex of n_axis F dA, where F rises from 0 at the root of the column to
/// +-height at its exit and stays constant beyond.
template <int dim>
double column_flux(const std::array<Point<dim>, dim>& corners, const Column<dim>& column) {
  if (const auto flux = whole_flux<dim>(corners, column))
    return *flux;
  ConvexPart<dim, false> part(corners);
  for (int a = 0; a < dim; ++a) {
    if (a == column.axis)
      continue;
    part.keep(a, column.box.min()[a], +1);
    part.keep(a, column.box.max()[a], -1);
  }
  part.keep(column.axis, column.root(), column.side);
  if (part.n_vertices() < dim)
    return 0;
  ConvexPart<dim, false> within = part;
  within.keep(column.axis, column.exit(), -column.side);
  // A part in the exit plane itself belongs to one of the two halves only.
  bool any_beyond = false;
  for (int i = 0; i < part.n_vertices(); ++i)
    any_beyond |= column.side * (part.position(i)[column.axis] - column.exit()) > 0;
  if (!any_beyond)
    return flux_through(within, column.axis, column.root()).moment;
  part.keep(column.axis, column.exit(), column.side);
  return flux_through(within, column.axis, column.root()).moment +
         flux_through(part, column.axis, column.root()).area * (column.exit() - column.root());
}

/// The shortest of the columns that leave the bounds of a solid.
template <int dim>
Column<dim> shortest_column(const Box<dim>& box, const Box<dim>& bounds) {
  Column<dim> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (int a = 0; a < dim; ++a)
    for (const int side : {1, -1}) {
      const double length =
          side > 0 ? bounds.max()[a] - box.min()[a] : box.max()[a] - bounds.min()[a];
      if (length < shortest) {
        shortest = length;
        best = {box, a, side};
      }
    }
  return best;
}

}  // namespace

// The divergence theorem for the field F(x_axis) e_axis: its divergence is one inside the box's
// slab and zero elsewhere, and cutting the surface to the column adds only sides normal to other
// axes. So the sides of the box never enter, and the result is exact for polyhedra.
template <int dim>
double solid_volume_in_box(const SurfaceSnapshot<dim>& surface, const Box<dim>& box, int solid) {
  const Box<dim> bounds = surface.bounds_of_solid(solid);
  const Column<dim> column = shortest_column<dim>(box, bounds);
  Box<dim> reach = box;
  (column.side > 0 ? reach.max() : reach.min())[column.axis] =
      (column.side > 0 ? bounds.max() : bounds.min())[column.axis];
  double volume = 0;
  std::vector<int> simplices;
  surface.touching(reach, simplices);
  for (const int s : simplices)
    if (surface.solid_of(s) == solid)
      volume += column_flux<dim>(surface.corners(s), column);
  return std::clamp(volume, 0.0, box.volume());
}

template <int dim>
double solid_volume_in_box(const SurfaceSnapshot<dim>& surface, const Box<dim>& box) {
  std::vector<int> solids;
  surface.solids_touching(box, solids);
  double volume = 0;
  for (const int solid : solids)
    if (surface.solids()[solid].closed)
      volume += solid_volume_in_box<dim>(surface, box, solid);
  return std::min(volume, box.volume());
}

namespace {

/// Volume and first moments, about `origin`.
template <int dim>
struct VolumeMoments {
  double volume = 0;
  Point<dim> first = Point<dim>::Zero();
};

/// The integrals over x_0, from the side at `root` to x but at most to `exit`, of 1 and of x.
template <int dim>
VolumeMoments<dim> below(const Point<dim>& x, double root, double exit) {
  const double top = std::min(x[0], exit);
  VolumeMoments<dim> below;
  below.volume = top - root;
  below.first = below.volume * x;
  below.first[0] = 0.5 * (top * top - root * root);
  return below;
}

/// Adds n_0 times those over a part on one side of `exit`: quadratic, so that the middles of the
/// edges (2D: Simpson's points) make it exact.
template <int dim>
void add_below(const ConvexPart<dim, false>& part, double root, double exit,
               VolumeMoments<dim>& sum) {
  const auto add = [&](double weight, const Point<dim>& x) {
    const VolumeMoments<dim> at_x = below<dim>(x, root, exit);
    sum.volume += weight * at_x.volume;
    sum.first += weight * at_x.first;
  };
  for (int i = 1; i + dim - 2 < part.n_vertices(); ++i) {
    std::array<Point<dim>, dim> points;
    for (int k = 0; k < dim; ++k)
      points[k] = part.position(k == 0 ? 0 : i + k - 1);
    const double area = area_vector<dim>(points)[0];
    if constexpr (dim == 2) {
      add(area / 6, points[0]);
      add(area * 4 / 6, 0.5 * (points[0] + points[1]));
      add(area / 6, points[1]);
    } else {
      for (int k = 0; k < 3; ++k)
        add(area / 3, 0.5 * (points[k] + points[(k + 1) % 3]));
    }
  }
}

/// Volume and centroid of a closed solid.
template <int dim>
PartOfSolid<dim> whole_solid(const SurfaceSnapshot<dim>& surface, int solid) {
  const Point<dim> origin = surface.own_bounds(solid).center();  // less round-off
  const SolidDescription& description = surface.solids()[solid];
  VolumeMoments<dim> sum;
  for (int s = description.simplex_begin; s < description.simplex_end; ++s) {
    auto corners = surface.corners(s);
    Point<dim> of_corners = Point<dim>::Zero();
    for (Point<dim>& corner : corners)
      of_corners += corner -= origin;
    const double cone = area_vector<dim>(corners).dot(corners[0]) / dim;
    sum.volume += cone;
    sum.first += cone / (dim + 1) * of_corners;
  }
  if (sum.volume == 0)
    return {0, origin};
  return {sum.volume, origin + sum.first / sum.volume};
}

}  // namespace

namespace {

template <int dim>
using Rotation = Eigen::Matrix<double, dim, dim>;

/// As above, with the column along axis 0 and the fields whose divergences are 1 and x in the box.
/// The box, which is finite at the lower end of axis 0, is that of coordinates R (x - origin).
template <int dim>
PartOfSolid<dim> part_in_rotated_box(const SurfaceSnapshot<dim>& surface, int solid,
                                     const Rotation<dim>& rotation, const Box<dim>& box) {
  const PartOfSolid<dim> whole = whole_solid<dim>(surface, solid);
  const Point<dim> origin = whole.centroid;  // less round-off
  const Point<dim> lower = box.min() - rotation * origin, upper = box.max() - rotation * origin;
  VolumeMoments<dim> sum;
  const SolidDescription& description = surface.solids()[solid];
  for (int s = description.simplex_begin; s < description.simplex_end; ++s) {
    auto corners = surface.corners(s);
    for (Point<dim>& corner : corners)
      corner = rotation * Point<dim>(corner - origin);
    ConvexPart<dim, false> within(corners);
    for (int a = 1; a < dim; ++a) {
      within.keep(a, lower[a], +1);
      within.keep(a, upper[a], -1);
    }
    within.keep(0, lower[0], +1);
    ConvexPart<dim, false> beyond = within;
    within.keep(0, upper[0], -1);
    bool any_beyond = false;  // simplices in the plane of the exit count once
    for (int i = 0; i < beyond.n_vertices(); ++i)
      any_beyond |= beyond.position(i)[0] > upper[0];
    add_below<dim>(within, lower[0], upper[0], sum);
    if (any_beyond) {
      beyond.keep(0, upper[0], +1);
      add_below<dim>(beyond, lower[0], upper[0], sum);
    }
  }
  if (sum.volume <= 1e-14 * whole.volume)
    return {0, whole.centroid};
  return {sum.volume, origin + rotation.transpose() * Point<dim>(sum.first / sum.volume)};
}

}  // namespace

template <int dim>
PartOfSolid<dim> part_of_solid(const SurfaceSnapshot<dim>& surface, int solid,
                               const Box<dim>& box) {
  const Box<dim> bounds = surface.own_bounds(solid);
  if (box.contains(bounds))
    return whole_solid<dim>(surface, solid);
  if (!box.intersects(bounds))
    return {0, whole_solid<dim>(surface, solid).centroid};
  return part_in_rotated_box<dim>(surface, solid, Rotation<dim>::Identity(), box);
}

template <int dim>
PartOfSolid<dim> part_below(const SurfaceSnapshot<dim>& surface, int solid, const Box<dim>& box,
                            const Point<dim>& up, double level) {
  int axis = 0;
  if (up.cwiseAbs().maxCoeff(&axis) == 1) {
    Box<dim> part = box;
    if (up[axis] > 0)
      part.max()[axis] = std::min(part.max()[axis], level);
    else
      part.min()[axis] = std::max(part.min()[axis], -level);
    return part.isEmpty() ? PartOfSolid<dim>{0, whole_solid<dim>(surface, solid).centroid}
                          : part_of_solid<dim>(surface, solid, part);
  }
  const double far = surface.own_bounds(solid).diagonal().norm() +
                     std::abs(up.dot(surface.own_bounds(solid).center()) - level);
  // A rotation that takes `up` to axis 0.
  Rotation<dim> rotation;
  if constexpr (dim == 2)
    rotation << up[0], up[1], -up[1], up[0];
  else
    rotation =
        Eigen::Quaterniond::FromTwoVectors(up, Point<dim>(Point<dim>::Unit(0))).toRotationMatrix();
  const Point<dim> center = rotation * surface.own_bounds(solid).center();
  Box<dim> half_space(center - Point<dim>::Constant(far), center + Point<dim>::Constant(far));
  half_space.max()[0] = std::min(half_space.max()[0], level);
  return part_in_rotated_box<dim>(surface, solid, rotation, half_space);
}

template PartOfSolid<2> part_of_solid<2>(const SurfaceSnapshot<2>&, int, const Box<2>&);
template PartOfSolid<3> part_of_solid<3>(const SurfaceSnapshot<3>&, int, const Box<3>&);
template PartOfSolid<2> part_below<2>(const SurfaceSnapshot<2>&, int, const Box<2>&,
                                      const Point<2>&, double);
template PartOfSolid<3> part_below<3>(const SurfaceSnapshot<3>&, int, const Box<3>&,
                                      const Point<3>&, double);
template double solid_volume_in_box<2>(const SurfaceSnapshot<2>&, const Box<2>&, int);
template double solid_volume_in_box<3>(const SurfaceSnapshot<3>&, const Box<3>&, int);
template double solid_volume_in_box<2>(const SurfaceSnapshot<2>&, const Box<2>&);
template double solid_volume_in_box<3>(const SurfaceSnapshot<3>&, const Box<3>&);

}  // namespace lockstep
