#pragma once
#include <string>
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
  /// What combinations have beside their terms when bodies move so that all joints fit, on the
  /// stacked map. Null: some joints could not be closed, or are not to be; then V is that of bodies
  /// which follow the rates of their joints, and all of the joints' impulse belongs to the end of
  /// the step.
  RCP<Vector> drift;
};

/// A coordinate of a joint after a step, for joints.csv: of an angle in rad, of a displacement in
/// m.
struct JointState {
  std::string name;    ///< of the joint
  int coordinate = 0;  ///< from 1; 0 if it has one alone, or none
  double q = 0, rate = 0, target = 0;
  double torque = 0;        ///< mean over the step, of control on the second solid [N m, N]
  double power = 0;         ///< of control, mean over the step [W]
  double limit_torque = 0;  ///< mean over the step, of limits on the second solid [N m, N]
  double gap = 0;           ///< of the joint [m, rad]
  bool two_halves = false;  ///< half of its impulse acted where the step began
  bool at_limit = false;    ///< or beyond
};

/// A limit that joints set to their coordinates. Per step of dt, sum_k weight_k V_k may not be
/// below -room / dt. Weights make it a speed, of what is as far away as the solids reach [m/s].
struct JointLimit {
  std::vector<std::pair<GlobalIndex, double>> terms;  ///< dof and weight
  double room = 0;  ///< how far the coordinate may still go [m]; negative: it is beyond
};

/// What joints gave in a step, generalized.
struct JointImpulses {
  /// Of what holds given dofs (`Reduction::on_given`), where the step began (null: nothing), and
  /// where it ended.
  RCP<const Vector> at_start, at_end;
  std::vector<std::pair<GlobalIndex, double>>
      of_limits;  ///< dof and impulse; the same on all ranks
};

/// Dofs whose velocities are given.
struct GivenMotion {
  std::string name;  ///< of what moves them, as messages have it
  std::vector<GlobalIndex> dofs;
};

/// Ties between solids of one or more models, as combinations of dofs (coupling/reduction.hpp), so
/// that every solve meets them exactly. Velocities that do may still take positions off them by
/// O(dt^2): `close` mends that. Dofs are those of the stack of all solids.
class ConstraintModel : public PlugIn {
 public:
  /// At the present positions. Local, the same on all ranks.
  virtual std::vector<Combination> combinations() const = 0;
  /// S1: changes V (stacked, of all dofs), which is about to move all solids from `time` by dt, as
  /// if they had no midpoint corrections: who adds these asks for a `FreeFlight`. Collective.
  virtual ClosedMotion close(double time, double dt, Vector& velocity) = 0;
  /// At the present positions, for motions with about the velocity V (by dof, of all solids).
  /// Local, the same on all ranks.
  virtual std::vector<JointLimit> limits(double dt, const std::vector<double>& velocity) const = 0;
  /// Joints whose rates are given, and prescribed solids that carry others.
  virtual std::vector<GivenMotion> given_motions() const = 0;
  /// The name of a joint that has limits; empty: none.
  virtual std::string limited() const = 0;
  /// Whether forces on their own dofs are implicit: springs, dampers.
  virtual bool has_implicit_forces() const = 0;
  /// At most as many unknowns move the solids that are tied to one another.
  virtual int largest_block() const = 0;
  /// At the end of a step from `time` over dt, whose velocities joints know already. Collective.
  virtual void take_note(const JointImpulses& impulses, double time, double dt) = 0;
  /// Targets are those of `time`. Local, the same on all ranks.
  virtual std::vector<JointState> states(double time) const = 0;
  /// What there is, for `--explain`. Local.
  virtual std::string note() const = 0;
};

}  // namespace lockstep
