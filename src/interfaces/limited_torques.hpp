#pragma once
#include <vector>

namespace lockstep {

/// Joints whose springs may give a largest torque only.
class LimitedTorques {
 public:
  virtual ~LimitedTorques() = default;
  /// True for each joint coordinate whose spring gave its largest torque in the last step, in the
  /// order of `ConstraintModel::states`. Local.
  virtual std::vector<char> limited_torques() const = 0;
};

}  // namespace lockstep
