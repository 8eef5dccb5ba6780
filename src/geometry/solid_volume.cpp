#include "geometry/solid_volume.hpp"

#include <algorithm>
#include <limits>

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

/// The integral over a simplex of n_axis F dA, where F rises from 0 at the root of the column to
/// +-height at its exit and stays constant beyond.
template <int dim>
double column_flux(const std::array<Point<dim>, dim>& corners, const Column<dim>& column) {
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
  std::vector<int> simplices;
  surface.touching(reach, simplices);
  double volume = 0;
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

template double solid_volume_in_box<2>(const SurfaceSnapshot<2>&, const Box<2>&, int);
template double solid_volume_in_box<3>(const SurfaceSnapshot<3>&, const Box<3>&, int);
template double solid_volume_in_box<2>(const SurfaceSnapshot<2>&, const Box<2>&);
template double solid_volume_in_box<3>(const SurfaceSnapshot<3>&, const Box<3>&);

}  // namespace lockstep
