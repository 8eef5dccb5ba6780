#pragma once
#include <optional>
#include <vector>

#include "articulated/closing.hpp"

namespace lockstep {

/// What comes of a mechanism that moves by itself.
template <int dim>
struct Flight {
  std::vector<BodyMotion<dim>> motions;  ///< by body; momenta just after the first impulse
  /// What joints gave, that one included, but for what the end still asks for: by body, about its
  /// reference point, which has moved meanwhile.
  std::vector<TwistVector<dim>> given;
  std::vector<Eigen::VectorXd> coordinates;  ///< of all joints, at the end
};

/// How finely a mechanism's own motion is resolved.
struct FlightSteps {
  int least = 1;           ///< so many parts at least
  double longest = 1e300;  ///< and none that turns a body by more [rad]
};

/// Free bodies and their joints alone for a step (RATTLE, each body by Euler's equations): as many
/// times as it takes, joints give what closes them, bodies move, and joints take from them what
/// they do not let. `motions`: momenta with which they set out. Empty if joints cannot be closed,
/// or steps get too many. Nothing else may act on the bodies in between: no motors, no prescribed
/// bodies. With one part only what closes joints at the begin is given, and there may be. Local.
template <int dim>
std::optional<Flight<dim>> fly(const ClosingProblem<dim>& problem, const FlightSteps& steps,
                               const std::vector<BodyMotion<dim>>& motions);

}  // namespace lockstep
