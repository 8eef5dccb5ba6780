#pragma once
#include <array>
#include <optional>
#include <vector>

#include "geometry/moving_surface.hpp"
#include "transport/nearby_surface.hpp"
#include "transport/sample_lattice.hpp"

namespace lockstep {

template <int dim>
class BoxVisibility;

/// Marks the samples that may be interpolated from, by id on the sample grid (0: not).
template <int dim>
struct UsableSamples {
  std::array<const char*, dim> faces;
  const char* cells = nullptr;
  /// True for lower sides through which no velocity goes. Upper ones have their samples only if it
  /// does (Stencil::wall_sample).
  std::array<bool, dim> closed_below{};
};

/// A weighted mean that is exact for equal values and never leaves their range.
class WeightedMean {
 public:
  void add(double weight, double value);
  std::optional<double> value() const;

 private:
  double weight_ = 0, base_ = 0, sum_ = 0, low_ = 0, high_ = 0;
};

/// Interpolation near surfaces: only samples that are usable and visible from the point count.
/// Points are in lattice units, fields on the sample grid.
template <int dim>
class VisibleInterpolation {
 public:
  /// All components of a velocity, on the sample grid.
  using Velocity = std::array<const double*, dim>;

  /// All references must outlive this object. `nearby` is made of `surface.before`.
  VisibleInterpolation(const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice,
                       const UsableSamples<dim>& usable, const MovingSurface<dim>& surface,
                       double friction_speed, std::shared_ptr<const NearbySurface<dim>> nearby)
      : grid_(grid),
        lattice_(lattice),
        usable_(usable),
        surface_(surface),
        friction_speed_(friction_speed),
        nearby_(std::move(nearby)) {}

  /// Returns a velocity component of fluid that slips: samples hidden by a surface take the mean of
  /// the visible ones, with the normal part replaced by the surface's; the tangential parts of the
  /// two differ by less, as friction reduces the slip. None if nothing is visible and no surface in
  /// sight.
  std::optional<double> velocity(int axis, const Point<dim>& x, const Velocity& field);
  /// A scalar from the visible samples alone, their weights scaled to sum to one; none if there are
  /// no such samples.
  std::optional<double> scalar(const Point<dim>& x, const double* field);
  /// All components of a velocity; where nothing is in sight, that of the nearest surface.
  Point<dim> velocity_at(const Point<dim>& x, const Velocity& field);

  const NearbySurface<dim>& nearby() const { return *nearby_; }
  Point<dim> physical(const Point<dim>& x) const { return grid_.lower() + grid_.spacing() * x; }
  /// The inverse: lattice units.
  Point<dim> place_of(const Point<dim>& position) const {
    return (position - grid_.lower()) / grid_.spacing();
  }
  double spacing() const { return grid_.spacing(); }
  Box<dim> physical(const Box<dim>& box) const {
    return {physical(Point<dim>(box.min())), physical(Point<dim>(box.max()))};
  }
  /// Velocity of the nearest surface point within three cells of x, or zero.
  Point<dim> nearest_surface_velocity(const Point<dim>& x) const;

 private:
  /// True if all samples of the stencil around x have values that count.
  bool all_count(SampleKind kind, const Point<dim>& x, const Stencil<dim>& stencil) const;
  /// Adds those of the samples around x that are `seen` (bits) and count.
  void add_seen(SampleKind kind, const Point<dim>& x, const Stencil<dim>& stencil, unsigned seen,
                const double* field, WeightedMean& mean) const;
  /// Sends rays to all samples around x: returns those that are seen, and calls
  /// f(weight, what hides it) for the others.
  template <typename Function>
  unsigned send_rays(SampleKind kind, const Point<dim>& x, const Function& f) const;
  /// Sends rays to those of the samples around x that are `unknown` alone.
  template <typename Function>
  unsigned send_rays_to(unsigned unknown, SampleKind kind, const Point<dim>& x,
                        const Function& f) const;
  struct Found {
    unsigned seen = 0;    ///< samples, bit k for corner k
    unsigned hidden = 0;  ///< samples to which no ray was sent
  };
  /// Finds the samples around x that are seen, and calls f(weight, what hides it) for those that
  /// rays have found hidden; `box`: that around x, null if no surface comes into it.
  template <typename Function>
  Found find_seen(SampleKind kind, const Point<dim>& x, const BoxVisibility<dim>* box,
                  const Function& f) const;
  struct Hidden {
    double weight = 0;
    SurfacePoint<dim> hit;
  };
  /// The `hidden` samples around x as one behind what hides their centre of weights: where x passes
  /// from one box of samples to the next, that is the same. None if they have no weight.
  std::optional<Hidden> hidden_together(SampleKind kind, const Point<dim>& x,
                                        const Stencil<dim>& stencil, unsigned hidden,
                                        const BoxVisibility<dim>& box) const;
  /// Visibility of the samples of one component around a point.
  struct Sight {
    WeightedMean visible;
    std::vector<Hidden> hidden;
  };
  void look(int axis, const Point<dim>& x, const double* field);
  /// Value of a component; if some of its samples are hidden, the sight of all components must be
  /// known.
  std::optional<double> seen_velocity(int axis) const;
  /// Returns the velocity that a surface makes of a velocity `seen` before it: no longer than the
  /// two together.
  double slipping(int axis, const Point<dim>& seen, const SurfacePoint<dim>& hit) const;

  const TiledGrid<dim>& grid_;
  const SampleLattice<dim>& lattice_;
  const UsableSamples<dim>& usable_;
  const MovingSurface<dim>& surface_;
  double friction_speed_;  ///< decrease of the slip velocity by friction [m/s]
  std::shared_ptr<const NearbySurface<dim>> nearby_;
  std::array<Sight, dim> sight_;  ///< sight of each component, from the point looked at last
};

}  // namespace lockstep
