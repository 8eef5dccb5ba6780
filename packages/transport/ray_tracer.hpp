#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "transport/sample_lattice.hpp"

namespace lockstep {

/// A ray from a sample, cut at the sides of the domain. Lattice units.
template <int dim>
struct Ray {
  Point<dim> middle = Point<dim>::Zero();  ///< where the midpoint rule looked
  Point<dim> end = Point<dim>::Zero();
  bool complete = true;  ///< all samples on the way are stored here
  bool clipped = false;  ///< it would have left the domain
  int inflow_axis = -1;  ///< it left through the inflow side of this axis, or ends beside it
  int inflow_side = 0;
  double inflow_share = 0;  ///< share of the inflow in its end: 1 if it left
  double past = -1e300;     ///< distance beyond that side at which it would have ended; < 0: inside
};

/// Follows the advection velocity over one step with the midpoint rule, away from surfaces.
template <int dim>
class RayTracer {
 public:
  /// `velocity` on the sample grid [m/s]; `cells_per_velocity` = dt / h.
  RayTracer(const SampleLattice<dim>& lattice, const std::array<std::array<bool, 2>, dim>& inflow,
            const std::array<const double*, dim>& velocity, double cells_per_velocity)
      : lattice_(lattice),
        inflow_(inflow),
        velocity_(velocity),
        cells_per_velocity_(cells_per_velocity) {}

  /// Traces a ray from x against the flow (direction -1) or with it (+1). `cubic`: the velocity
  /// is interpolated by cubics.
  Ray<dim> trace(const Point<dim>& x, double direction, bool cubic = false) const;
  /// Cuts the segment x -> end at the domain: at an inflow side where it leaves, elsewhere it
  /// slides.
  void clip(const Point<dim>& x, Ray<dim>& ray) const;

  /// Blends the inflow's value into rays that end between an inflow side and the first samples,
  /// which lie half a cell inside, where fluid does enter. Samples of `kind` that lie on the side
  /// itself have its values already. `depth`: distance from the side up to which rays are marked;
  /// the first half cell of it has a share.
  void mix_inflow(SampleKind kind, Ray<dim>& ray, double depth = first_sample) const;

  const SampleLattice<dim>& lattice() const { return lattice_; }
  bool flows_in(int axis, int side) const { return inflow_[axis][side]; }
  const std::array<const double*, dim>& velocity() const { return velocity_; }
  double cells_per_velocity() const { return cells_per_velocity_; }

 private:
  static constexpr double first_sample = 0.5;  ///< inside of a side [cells]

  bool displacement(const Point<dim>& x, bool cubic, Point<dim>& d) const;
  /// Moves x into the domain along the axes that are not periodic; true if it was outside.
  bool clamp(Point<dim>& x) const;

  const SampleLattice<dim>& lattice_;
  std::array<std::array<bool, 2>, dim> inflow_;
  std::array<const double*, dim> velocity_;
  double cells_per_velocity_;
};

template <int dim>
bool RayTracer<dim>::displacement(const Point<dim>& x, bool cubic, Point<dim>& d) const {
  for (int a = 0; cubic && a < dim; ++a) {
    const WideStencil<dim> stencil = lattice_.locate_wide(a, x);
    if (!stencil.complete())
      return false;
    d[a] = interpolate<dim>(stencil, velocity_[a]) * cells_per_velocity_;
  }
  if (cubic)
    return true;
  const auto stencils = lattice_.locate_faces(x);
  for (int a = 0; a < dim; ++a) {
    if (!stencils[a].complete())
      return false;
    d[a] = interpolate<dim>(stencils[a], velocity_[a]) * cells_per_velocity_;
  }
  return true;
}

template <int dim>
Ray<dim> RayTracer<dim>::trace(const Point<dim>& x, double direction, bool cubic) const {
  Ray<dim> ray;
  Point<dim> d;
  ray.complete = displacement(x, cubic, d);
  if (!ray.complete)
    return ray;
  ray.middle = x + 0.5 * direction * d;
  clamp(ray.middle);
  ray.complete = displacement(ray.middle, cubic, d);
  ray.end = x + direction * d;
  clip(x, ray);
  return ray;
}

template <int dim>
bool RayTracer<dim>::clamp(Point<dim>& x) const {
  bool outside = false;
  for (int a = 0; a < dim; ++a) {
    if (lattice_.periodic(a) || (x[a] >= 0 && x[a] <= lattice_.n_cells()[a]))
      continue;
    x[a] = std::clamp<double>(x[a], 0, lattice_.n_cells()[a]);
    outside = true;
  }
  return outside;
}

template <int dim>
void RayTracer<dim>::clip(const Point<dim>& x, Ray<dim>& ray) const {
  double fraction = 1;
  for (int a = 0; a < dim; ++a) {
    const double n = lattice_.n_cells()[a];
    if (lattice_.periodic(a) || (ray.end[a] >= 0 && ray.end[a] <= n))
      continue;
    const int side = ray.end[a] < 0 ? 0 : 1;
    if (!inflow_[a][side])
      continue;
    const double leaves = (side * n - x[a]) / (ray.end[a] - x[a]);
    if (leaves >= fraction)
      continue;
    fraction = leaves;
    ray.inflow_axis = a;
    ray.inflow_side = side;
    ray.past = side == 0 ? -ray.end[a] : ray.end[a] - n;
  }
  if (ray.inflow_axis >= 0) {
    ray.end = x + fraction * (ray.end - x);
    ray.inflow_share = 1;
  }
  ray.clipped = clamp(ray.end) || ray.inflow_axis >= 0;
}

template <int dim>
void RayTracer<dim>::mix_inflow(SampleKind kind, Ray<dim>& ray, double depth) const {
  for (int a = 0; a < dim && ray.inflow_share == 0; ++a) {
    for (int side = 0; side < 2 && a != kind; ++side) {
      const double n = lattice_.n_cells()[a];
      const double gap = side == 0 ? ray.end[a] : n - ray.end[a];
      if (!inflow_[a][side] || gap >= depth || -gap <= ray.past)
        continue;
      Point<dim> place = ray.end;
      place[a] = side * n;
      Stencil<dim> face = lattice_.locate_faces(place)[a];
      for (double& weight : face.weight)
        weight = std::round(weight);  // the nearest: openings end between faces
      const double velocity = face.complete() ? interpolate<dim>(face, velocity_[a]) : 0;
      if ((side == 0 ? velocity : -velocity) <= 0)
        continue;
      ray.inflow_axis = a;
      ray.inflow_side = side;
      ray.inflow_share = std::max(0.0, 1 - gap / first_sample);
      ray.past = -gap;
    }
  }
}

}  // namespace lockstep
