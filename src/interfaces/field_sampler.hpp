#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// State of a fluid at one point.
template <int dim>
struct FluidSample {
  bool in_fluid = false;                     ///< false: in a solid or outside; all else is zero
  double pressure = 0;                       ///< [Pa]
  Point<dim> velocity = Point<dim>::Zero();  ///< [m/s]
};

/// Flow of a fluid through a plane at one point.
struct FlowSample {
  double open = 0;  ///< part of the plane there that fluid can go through [1]; 0: all else is zero
  double rate = 0;  ///< volume by area, open or not, and time, along the axis [m/s]
  double pressure = 0;  ///< [Pa]
};

/// A side interface of fluids that can be sampled at any point. Observers need it; a fluid without
/// it runs all the same.
template <int dim>
class FieldSampler {
 public:
  virtual ~FieldSampler() = default;
  /// The state at the end of the last step, one sample a point [m], the same on all ranks.
  /// Collective; all ranks ask for the same points.
  virtual std::vector<FluidSample<dim>> sample(const std::vector<Point<dim>>& points) const = 0;
  /// Samples the flow through planes normal to `axis` at these points, with the volume that the
  /// fluid's own mass balance takes through. Default: entirely open or closed, as `sample` finds
  /// the point. Collective.
  virtual std::vector<FlowSample> flow_across(int axis,
                                              const std::vector<Point<dim>>& points) const {
    std::vector<FlowSample> flows;
    for (const FluidSample<dim>& one : sample(points))
      flows.push_back({one.in_fluid ? 1. : 0., one.velocity[axis], one.pressure});
    return flows;
  }
};

}  // namespace lockstep
