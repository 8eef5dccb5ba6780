#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "transport/grid_state.hpp"
#include "transport/ray_tracer.hpp"
#include "transport/visible_interpolation.hpp"

namespace lockstep {

/// One field being carried, on the sample grid.
template <int dim>
struct CarriedField {
  SampleKind kind = cell_centers;
  const double* values = nullptr;
  /// All components of the velocity that an advected component belongs to, which surfaces mix.
  std::array<const double*, dim> velocity{};
  /// Value of the field where a ray leaves through an inflow side.
  std::function<double(const Ray<dim>&)> inflow;
  /// Value there instead if it depends on the distance from the side and on the value `inside`, at
  /// the ray's end.
  std::function<double(const Ray<dim>&, double inside)> enters = nullptr;
  double inflow_depth =
      0.5;  ///< distance from an inflow side within which rays may end that it concerns [cells]
};

/// Reach of the rays of a step, and what slows them beside surfaces.
struct RayExtent {
  double largest_displacement = 0;  ///< along an axis [cells]
  int stencil_reach = 1;      ///< distance of the farthest samples used at the end of a ray [cells]
  double friction_speed = 0;  ///< decrease of the slip velocity by friction [m/s]
};

/// Transport of single samples near surfaces. Points and boxes are in lattice units.
template <int dim>
class SurfaceTransport {
 public:
  /// References must outlive this object.
  SurfaceTransport(const TiledGrid<dim>& grid, const RayTracer<dim>& tracer,
                   const UsableSamples<dim>& usable, const MovingSurface<dim>& surface,
                   KeptSurface<dim>& kept, const RayExtent& rays);

  /// True if a surface may come into the way of a ray from the sample, forth or back, or sweep over
  /// it.
  bool is_near(const Point<dim>& x) const { return within(x, near_reach_); }
  /// True if some sample of the tile that begins there may be near a surface.
  bool is_near_tile(const Index<dim>& tile_begin) const;
  /// True if a surface may come into the sample's cell during the step.
  bool may_be_swept(const Point<dim>& x) const {
    return within(x, cells_reached(surface_displacement_));
  }
  /// True if the sample changes sides of a surface or is on one at t^n or t^{n+1}.
  bool swept(const Point<dim>& x) const;
  /// True if the centre of an advected face or of a cell in this state is inside a closed solid at
  /// t^n.
  bool inside(const Point<dim>& x, CellState cell) const;
  /// True if no surface touches the points and their surroundings of `reach` cells, at t^n or, with
  /// `during_step`, at any time of the step.
  bool clear(const Box<dim>& points, bool during_step, int reach = 1) const;
  /// True if no surface comes between the sample at x, the path of its ray and all samples used on
  /// it, so that it can be advected as if there were none. Possible where `clear` is false.
  bool sees_all(SampleKind kind, const Point<dim>& x, const Ray<dim>& ray) const;
  /// Returns the value advected to the sample at x; none if it sees no valid sample.
  std::optional<double> advect(const CarriedField<dim>& field, const Point<dim>& x);
  /// Returns the place that fluid at x reaches in the step. Where a surface would pass it, it is
  /// kept a tenth of a cell from the surface, on its side; none if there is no room.
  std::optional<Point<dim>> follow(const Point<dim>& x);
  /// Advects a velocity `own` of a sample whose fluid is at x, beside it: it changes as the
  /// velocity seen at x does, and relaxes to that as fluid passes, so that no error accumulates in
  /// it.
  double advect_beside(const CarriedField<dim>& field, const Point<dim>& x, double own);

 private:
  /// Cells that a distance in cells reaches from any place in a cell.
  static int cells_reached(double distance) {
    return static_cast<int>(std::min(std::ceil(distance + 0.01), 1e9));
  }
  /// True if a simplex comes within so many cells of the cell that holds x.
  bool within(const Point<dim>& x, int reach) const;
  /// Traces the fluid at x back, as far as it can be seen; sets `hit` if a surface is in the way.
  Ray<dim> trace(const Point<dim>& x, std::optional<SurfacePoint<dim>>& hit);
  /// The first surface that passes over a point that moves on a line during the step.
  std::optional<SurfacePoint<dim>> passage(const Point<dim>& from, const Point<dim>& to) const;
  /// True if no simplex comes within a distance [m] of the box of x and end during the step.
  bool stays_clear(const Point<dim>& x, const Point<dim>& end, double distance) const;
  std::optional<SurfacePoint<dim>> hit_on_way(const Point<dim>& x, const Point<dim>& end) const;
  /// Looks up the value at the end of a ray from x.
  std::optional<double> fetch(const CarriedField<dim>& field, const Point<dim>& x, Ray<dim> ray,
                              const std::optional<SurfacePoint<dim>>& hit);
  std::optional<double> look_up(const CarriedField<dim>& field, const Point<dim>& x);

  const SampleLattice<dim>& lattice_;
  const RayTracer<dim>& tracer_;
  const MovingSurface<dim>& surface_;
  double surface_displacement_;  ///< largest of a vertex over the step [cells]
  int near_reach_;               ///< surfaces within so many cells may matter to a sample
  VisibleInterpolation<dim> interpolation_;
  std::vector<Box<dim>> swept_;  ///< box of each simplex over the step, a little widened [m]
  BoxBins<dim> swept_bins_;
  mutable std::vector<int> candidates_;
};

}  // namespace lockstep
