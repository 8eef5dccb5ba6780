#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "interfaces/plug_in.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// A dof whose velocity is a combination of others': sum_k weight_k V_k. Those may be combinations
/// themselves, or given.
struct Combination {
  GlobalIndex dof = no_index;
  std::vector<std::pair<GlobalIndex, double>> terms;  ///< dof and weight
};

/// Result of `ConstraintModel::close`: a motion between whose begin and end bodies turn as their
/// momenta have it.
struct ClosedMotion {
  /// Velocity that a combination has beside its terms when bodies move so that all joints fit, on
  /// the stacked map. Null: some joints could not be closed, or are not to be; then V is the
  /// velocity of bodies which follow the rates of their joints, and the whole impulse of the joints
  /// belongs to the end of the step.
  RCP<Vector> constraint_error;
  /// With `constraint_error`: momentum that S1 adds in place of the solids' own
  /// `SolidModel::add_midpoint_correction`, now that the impulses at its begin are known. Null:
  /// theirs stays.
  RCP<Vector> correction;
  /// With `constraint_error`: impulse of the joints beside the reactions that S1 found, at the
  /// begin and on the way; part of the momentum of S2. Null: there is none.
  RCP<Vector> later_impulse;
  /// With `constraint_error`: 1 at the dofs of bodies and joints that could not be closed while
  /// others were, 0 elsewhere; their part of `constraint_error` is zero, and their whole impulse
  /// belongs to the end of the step. Null: all were closed.
  RCP<Vector> at_end;
};

/// A coordinate of a joint after a step, for joints.csv: an angle [rad] or a displacement [m].
struct JointState {
  std::string name;    ///< name of the joint
  int coordinate = 0;  ///< from 1; 0 if it has one alone, or none
  double q = 0, rate = 0, target = 0;
  double torque = 0;               ///< mean over the step, of control on the second solid [N m, N]
  double power = 0;                ///< power of the control, mean over the step [W]
  double limit_torque = 0;         ///< mean over the step, of limits on the second solid [N m, N]
  double gap = 0;                  ///< gap between the sides of the joint [m, rad]
  bool two_halves = false;         ///< half of its impulse acted where the step began
  bool at_limit = false;           ///< true also beyond a limit
  bool at_largest_torque = false;  ///< its spring gave its largest torque in the last step
};

/// A limit of a joint's coordinate: over a step of dt, sum_k weight_k V_k >= -room / dt. The
/// weights make the sum the speed [m/s] of a point as far from the joint as the solids reach.
struct JointLimit {
  std::vector<std::pair<GlobalIndex, double>> terms;  ///< dof and weight
  double room = 0;  ///< way that the coordinate may still go [m]; negative: it is beyond
};

/// Generalized impulses of the joints in one step.
struct JointImpulses {
  /// Impulses of the constraints that hold given dofs (`Reduction::on_given`): the part that acts
  /// where the step begins (null: nothing) and the part that acts where it ends.
  RCP<const Vector> at_start, at_end;
  std::vector<std::pair<GlobalIndex, double>>
      of_limits;  ///< dof and impulse; the same on all ranks
};

/// Dofs whose velocities are given.
struct GivenMotion {
  std::string name;  ///< name of their cause, as messages have it
  std::vector<GlobalIndex> dofs;
};

/// Ties between solids of one or more models, as combinations of dofs (coupling/reduction.hpp), so
/// that every solve meets them exactly. Velocities that do may still take positions off them by
/// O(dt^2): `close` mends that. Dofs are those of the stack of all solids.
class ConstraintModel : public PlugIn {
 public:
  /// Returns the combinations at the present positions. Local, the same on all ranks.
  virtual std::vector<Combination> combinations() const = 0;
  /// S1: changes V (stacked, of all dofs), which was found with the midpoint `correction` and is
  /// about to move all solids from `time` by dt; `solved` is V before contact changed it. The
  /// impulses belong to the motion without contact, since S1 drops what pushes solids out of one
  /// another. Collective.
  virtual ClosedMotion close(double time, double dt, const Vector& correction, const Vector& solved,
                             Vector& velocity) = 0;
  /// Returns the limits at the present positions that motions with about the velocity V (by dof, of
  /// all solids) may meet within dt. Local, the same on all ranks.
  virtual std::vector<JointLimit> limits(double dt, const std::vector<double>& velocity) const = 0;
  /// Joints whose rates are given, and prescribed solids that carry others.
  virtual std::vector<GivenMotion> given_motions() const = 0;
  /// The name of a joint that has limits; empty: none.
  virtual std::string limited() const = 0;
  /// True if forces on the joints' own dofs (springs, dampers) are implicit.
  virtual bool has_implicit_forces() const = 0;
  /// Largest number of unknowns that move solids which are tied to one another.
  virtual int largest_block() const = 0;
  /// Records the impulses at the end of a step from `time` over dt, whose velocities the joints
  /// know already. Collective.
  virtual void take_note(const JointImpulses& impulses, double time, double dt) = 0;
  /// Returns the states of all coordinates, with the targets at `time`. Local, the same on all
  /// ranks.
  virtual std::vector<JointState> states(double time) const = 0;
  /// Replaces the target of the scene from the next step on: q + (t - time) rate, by coordinate
  /// [rad, m; their rates]. A program around a run calls it alike on all ranks, and again after a
  /// restart: checkpoints do not keep it. Throws InputError if there is no such joint, if it is
  /// free, or if it has another number of coordinates. Default: throws it for all. Local.
  virtual void set_target(const std::string& joint, double /*time*/,
                          const std::vector<double>& /*q*/, const std::vector<double>& /*rate*/) {
    throw InputError(
        fmt::format("The joint \"{}\" cannot be steered: \"{}\" take no targets.", joint, name()));
  }
  /// Returns a description of the joints for `--explain`. Local.
  virtual std::string note() const = 0;
};

}  // namespace lockstep
