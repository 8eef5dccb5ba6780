#pragma once
#include <functional>
#include <memory>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// The surfaces of one step, from t^n to t^{n+1}, and how fast they move.
template <int dim>
struct MovingSurface {
  std::shared_ptr<const SurfaceSnapshot<dim>> before;  ///< at t^n
  std::shared_ptr<const SurfaceSnapshot<dim>> after;   ///< at t^{n+1}
  /// Velocity of a surface point [m/s] as F2 uses it: displacement over dt.
  std::function<Point<dim>(const SurfacePoint<dim>&)> velocity;
};

}  // namespace lockstep
