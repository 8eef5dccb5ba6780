#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "mac/transport/ray_tracer.hpp"
#include "mac/transport/visible_interpolation.hpp"

namespace lockstep {

/// One field being carried, on the sample grid.
template <int dim>
struct CarriedField {
  SampleKind kind = cell_centers;
  const double* values = nullptr;
  /// Of a velocity component: itself among the others, which surfaces mix.
  std::array<const double*, dim> velocity{};
  /// Its value where a ray leaves through an inflow side.
  std::function<double(const Ray<dim>&)> inflow;
};

/// Transport of single samples near surfaces. Points and boxes are in lattice units.
template <int dim>
class SurfaceTransport {
 public:
  /// `largest_displacement` of a ray along an axis, in cells, and `stencil_reach` of the farthest
  /// samples looked at from its end; `friction_speed` [m/s] is what friction takes off the speed at
  /// which fluid slips. References must outlive this object.
  SurfaceTransport(const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice,
                   const RayTracer<dim>& tracer, const UsableSamples<dim>& usable,
                   const MovingSurface<dim>& surface, double largest_displacement,
                   int stencil_reach, double friction_speed);

  /// True if a surface may come into the way of a ray from a sample of the owned cell, forth or
  /// back, or sweep over it.
  bool is_near(int cell) const { return !near_.empty() && near_[cell]; }
  /// True of some cell of the tile.
  bool is_near_tile(int tile) const { return !near_tiles_.empty() && near_tiles_[tile]; }
  /// Prepares the questions about samples in the cells [begin, end).
  void enter(const Index<dim>& begin, const Index<dim>& end);
  /// The sample changes sides or has none: swept over, or on a surface at t^n or t^{n+1}.
  bool swept(const Point<dim>& x) const;
  /// Inside a closed solid at t^n: possible for the centre of a coupled face.
  bool inside(const Point<dim>& x) const;
  /// True if no surface touches the points and their surroundings of `reach` cells, at t^n or, with
  /// `during_step`, at any time of the step.
  bool clear(const Box<dim>& points, bool during_step, int reach = 1) const;
  /// The value carried to the sample at x; none if it sees no valid sample.
  std::optional<double> carry(const CarriedField<dim>& field, const Point<dim>& x);
  /// A velocity `own` of the sample whose fluid is at x, beside it: changes as what is seen at x
  /// does, and becomes that as fluid passes, so that nothing gathers in it.
  double carry_beside(const CarriedField<dim>& field, const Point<dim>& x, double own);

 private:
  /// Where the fluid of x came from, as far as it can be seen; sets `hit` if a surface is in the
  /// way.
  Ray<dim> trace(const Point<dim>& x, std::optional<SurfacePoint<dim>>& hit);
  std::optional<SurfacePoint<dim>> hit_on_way(const Point<dim>& x, const Point<dim>& end) const;
  /// Looks up the value at the end of a ray from x.
  std::optional<double> fetch(const CarriedField<dim>& field, const Point<dim>& x, Ray<dim> ray,
                              const std::optional<SurfacePoint<dim>>& hit);
  std::optional<double> look_up(const CarriedField<dim>& field, const Point<dim>& x);

  const SampleLattice<dim>& lattice_;
  const RayTracer<dim>& tracer_;
  const MovingSurface<dim>& surface_;
  VisibleInterpolation<dim> interpolation_;
  int stencil_reach_;
  double surface_displacement_ = 0;  ///< largest of a vertex over the step [cells]
  double short_ray_ = 0;  ///< rays up to this length need only what is gathered around their start
  std::vector<char> near_, near_tiles_;  ///< owned cells and tiles; empty without surface
  std::vector<Box<dim>> swept_;  ///< box of each simplex over the step, a little widened [m]
  std::vector<int> around_;      ///< simplices whose swept box touches the box entered
  mutable std::vector<int> candidates_;
};

}  // namespace lockstep
