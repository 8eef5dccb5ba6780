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
  /// Of a velocity component: itself among the others, which surfaces mix.
  std::array<const double*, dim> velocity{};
  /// Its value where a ray leaves through an inflow side.
  std::function<double(const Ray<dim>&)> inflow;
  /// Instead, where it is what the side's distance makes of the value `inside`, at the ray's end.
  std::function<double(const Ray<dim>&, double inside)> enters = nullptr;
  double inflow_depth = 0.5;  ///< how near to an inflow side rays may end that it concerns [cells]
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
                   const MovingSurface<dim>& surface, KeptSurface<dim>& kept,
                   double largest_displacement, int stencil_reach, double friction_speed);

  /// True if a surface may come into the way of a ray from the sample, forth or back, or sweep over
  /// it.
  bool is_near(const Point<dim>& x) const { return within(x, near_reach_); }
  /// The same of some sample of the tile that begins there.
  bool is_near_tile(const Index<dim>& tile_begin) const;
  /// False if no surface comes into the sample's cell during the step.
  bool may_be_swept(const Point<dim>& x) const {
    return within(x, cells_reached(surface_displacement_));
  }
  /// The sample changes sides or has none: swept over, or on a surface at t^n or t^{n+1}.
  bool swept(const Point<dim>& x) const;
  /// Of a face that is carried, of a cell in this state: its centre is inside a closed solid at
  /// t^n.
  bool inside(const Point<dim>& x, CellState cell) const;
  /// True if no surface touches the points and their surroundings of `reach` cells, at t^n or, with
  /// `during_step`, at any time of the step.
  bool clear(const Box<dim>& points, bool during_step, int reach = 1) const;
  /// True if no surface comes between the sample at x, the way of its ray and all samples used on
  /// it: they might as well be carried as if there were none. Possible where it is not clear.
  bool sees_all(SampleKind kind, const Point<dim>& x, const Ray<dim>& ray) const;
  /// The value carried to the sample at x; none if it sees no valid sample.
  std::optional<double> carry(const CarriedField<dim>& field, const Point<dim>& x);
  /// Where fluid at x goes in the step, or none if a surface would pass it: then it is kept a tenth
  /// of a cell from the surface, on its side, and given up if there is no room.
  std::optional<Point<dim>> follow(const Point<dim>& x);
  /// A velocity `own` of the sample whose fluid is at x, beside it: changes as what is seen at x
  /// does, and becomes that as fluid passes, so that nothing gathers in it.
  double carry_beside(const CarriedField<dim>& field, const Point<dim>& x, double own);

 private:
  /// Cells that a distance in cells reaches from any place in a cell.
  static int cells_reached(double distance) {
    return static_cast<int>(std::min(std::ceil(distance + 0.01), 1e9));
  }
  /// True if a simplex comes within so many cells of the cell that holds x.
  bool within(const Point<dim>& x, int reach) const;
  /// Where the fluid of x came from, as far as it can be seen; sets `hit` if a surface is in the
  /// way.
  Ray<dim> trace(const Point<dim>& x, std::optional<SurfacePoint<dim>>& hit);
  /// The first surface that passes over a point that moves on a line during the step.
  std::optional<SurfacePoint<dim>> passage(const Point<dim>& from, const Point<dim>& to) const;
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
