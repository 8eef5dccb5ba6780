#pragma once
#include <string>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

// Side interfaces (`side_of`) of what a program around a run may change between its steps, alike on
// all ranks. Checkpoints keep none of it: whoever steers a run steers it again after a restart.

/// Solids that can be pushed, by their numbers in the model.
template <int dim>
class LoadableSolids {
 public:
  virtual ~LoadableSolids() = default;
  /// From the next step on, instead of the loads of the scene: a force at the centre of mass [N]
  /// and a torque about it [N m]. Throws InputError if the solid is prescribed. Local.
  virtual void set_load(int solid, const Point<dim>& force, const AngularVector<dim>& torque) = 0;
};

/// Joints under control.
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
