#pragma once
#include <array>
#include <optional>
#include <vector>

#include "interfaces/fluid.hpp"
#include "mac/nearby_surface.hpp"
#include "mac/sample_lattice.hpp"

namespace lockstep {

/// Which samples may be interpolated from, by id on the sample grid (0: not).
template <int dim>
struct UsableSamples {
  std::array<const char*, dim> faces;
  const char* cells = nullptr;
};

/// Interpolation near surfaces: only samples that are usable and visible from the point count.
/// Points are in lattice units, fields on the sample grid.
template <int dim>
class VisibleInterpolation {
 public:
  /// All arguments must outlive this object. `velocity` is that of a surface point.
  VisibleInterpolation(const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice,
                       const UsableSamples<dim>& usable, const MovingSurface<dim>& surface)
      : grid_(grid),
        lattice_(lattice),
        usable_(usable),
        surface_(surface),
        nearby_(surface.before, grid) {}

  /// Makes the questions about points well inside the box faster.
  void enter(const Box<dim>& box) { nearby_.enter(physical(box)); }
  /// Prepares interpolation at x and, to see far, at points within `radius` cells of it.
  void look_around(const Point<dim>& x, double radius = 0);
  /// A velocity component; samples hidden by the surface have the surface's velocity there. None if
  /// nothing is visible and no surface is in sight either.
  std::optional<double> velocity(int axis, const Point<dim>& x, const double* field);
  /// A scalar from the visible samples alone, their weights scaled to sum to one; none if there are
  /// no such samples.
  std::optional<double> scalar(const Point<dim>& x, const double* field);
  /// All components of a velocity; where nothing is in sight, that of the nearest surface.
  Point<dim> velocity_at(const Point<dim>& x, const std::array<const double*, dim>& field);

  const NearbySurface<dim>& nearby() const { return nearby_; }
  Point<dim> physical(const Point<dim>& x) const { return grid_.lower() + grid_.spacing() * x; }
  Box<dim> physical(const Box<dim>& box) const {
    return {physical(Point<dim>(box.min())), physical(Point<dim>(box.max()))};
  }
  /// Velocity of the nearest surface point within three cells of x, or zero.
  Point<dim> nearest_surface_velocity(const Point<dim>& x) const;

 private:
  /// The samples around x; simplices that could hide them are in focus.
  std::array<StencilCorner<dim>, (1 << dim)> focus(SampleKind kind, const Point<dim>& x);

  const TiledGrid<dim>& grid_;
  const SampleLattice<dim>& lattice_;
  const UsableSamples<dim>& usable_;
  const MovingSurface<dim>& surface_;
  NearbySurface<dim> nearby_;
};

}  // namespace lockstep
