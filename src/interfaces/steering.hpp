#pragma once
#include <string>
#include <vector>

namespace lockstep {

/// A side interface of joints (`side_of`) under control: a program around a run may change it
/// between steps, alike on all ranks. Checkpoints keep none of it: whoever steers a run steers it
/// again after a restart.
class SteeredJoints {
 public:
  virtual ~SteeredJoints() = default;
  /// From the next step on, instead of the target of the scene: q + (t - time) rate, by coordinate
  /// [rad, m; their rates]. Throws InputError if there is no such joint, if it is free, or if it
  /// has another number of coordinates. Local.
  virtual void set_target(const std::string& joint, double time, const std::vector<double>& q,
                          const std::vector<double>& rate) = 0;
};

}  // namespace lockstep
