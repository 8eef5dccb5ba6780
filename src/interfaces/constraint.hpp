#pragma once
#include <utility>
#include <vector>

#include "interfaces/plug_in.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// A dof whose velocity is a combination of others': sum_k weight_k V_k. Those may be combinations
/// themselves, or given.
struct Combination {
  GlobalIndex dof = no_index;
  std::vector<std::pair<GlobalIndex, double>> terms;  ///< dof and weight
};

/// Velocities that joints were asked to go with.
struct ClosedMotion {
  bool changed = false;  ///< were the velocities?
  /// What combinations have beside their terms when bodies move so that all joints fit, on the
  /// stacked map. Null: some joints could not be closed, or are not to be; then V is that of bodies
  /// which follow the rates of their joints, and all of the joints' impulse belongs to the end of
  /// the step.
  RCP<Vector> drift;
};

/// Ties between solids of one or more models, as combinations of dofs (coupling/reduction.hpp), so
/// that every solve meets them exactly. Velocities that do may still take positions off them by
/// O(dt^2): `close` mends that. Dofs are those of the stack of all solids.
class ConstraintModel : public PlugIn {
 public:
  /// At the present positions. Local, the same on all ranks.
  virtual std::vector<Combination> combinations() const = 0;
  /// S1: changes V (stacked, of all dofs), which is about to move all solids from `time` by dt.
  /// Collective.
  virtual ClosedMotion close(double time, double dt, Vector& velocity) = 0;
};

}  // namespace lockstep
