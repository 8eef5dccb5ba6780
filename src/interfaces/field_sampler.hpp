#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// What a fluid is like at one place.
template <int dim>
struct FluidSample {
  bool in_fluid = false;                     ///< false: in a solid or outside; all else is zero
  double pressure = 0;                       ///< [Pa]
  Point<dim> velocity = Point<dim>::Zero();  ///< [m/s]
};

/// A side interface of fluids that can be asked at any place. Observers want it; a fluid without it
/// runs all the same.
template <int dim>
class FieldSampler {
 public:
  virtual ~FieldSampler() = default;
  /// The state at the end of the last step, one sample a point [m], the same on all ranks.
  /// Collective; all ranks ask for the same points.
  virtual std::vector<FluidSample<dim>> sample(const std::vector<Point<dim>>& points) const = 0;
};

}  // namespace lockstep
