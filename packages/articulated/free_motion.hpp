#pragma once
#include <optional>
#include <vector>

#include "articulated/closing.hpp"

namespace lockstep {

/// Result of the free motion of a mechanism.
template <int dim>
struct FreeMotion {
  std::vector<BodyMotion<dim>> motions;  ///< by body; momenta just after the first impulse
  /// Impulses of the joints, the first one included, but not the impulse that the end of the step
  /// still needs: by body, about its reference point, which has moved meanwhile.
  std::vector<TwistVector<dim>> given;
  std::vector<Eigen::VectorXd> coordinates;  ///< coordinates of all joints, at the end
};

/// Resolution of a mechanism's own motion.
struct FreeMotionSteps {
  int least = 1;           ///< least number of parts
  double longest = 1e300;  ///< largest turn of a body in a part [rad]
};

/// Free bodies and their joints alone for a step (RATTLE, each body by Euler's equations):
/// repeatedly, joint impulses close the joints, bodies move, and joint impulses remove the
/// velocities that violate them. `motions`: momenta with which they set out. Empty if joints cannot
/// be closed, or steps get too many. Nothing else may act on the bodies in between: no motors, no
/// prescribed bodies. With one part there is only the impulse that closes joints at the begin, and
/// motors and prescribed bodies may act. Local.
template <int dim>
std::optional<FreeMotion<dim>> fly(const ClosingProblem<dim>& problem, const FreeMotionSteps& steps,
                                   const std::vector<BodyMotion<dim>>& motions);

}  // namespace lockstep
