#pragma once
#include <vector>

namespace lockstep {

/// Joints whose springs may give a largest torque only.
class LimitedTorques {
 public:
  virtual ~LimitedTorques() = default;
  /// Whether they gave that in the last step, by entry of `ConstraintModel::states`. Local.
  virtual std::vector<char> limited_torques() const = 0;
};

}  // namespace lockstep
