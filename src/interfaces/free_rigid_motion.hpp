#pragma once
#include "interfaces/constraint.hpp"

namespace lockstep {

/// A closed motion between whose begin and end bodies turn as their momenta have it.
struct ClosedFreeMotion : ClosedMotion {
  /// With `constraint_error`: momentum that S1 adds in place of the solids' own
  /// `SolidModel::add_midpoint_correction`, now that the impulses at its begin are known.
  RCP<Vector> correction;
  /// With `constraint_error`: impulse of the joints beside the reactions that S1 found, at the
  /// begin and on the way; part of the momentum of S2.
  RCP<Vector> later_impulse;
  /// With `constraint_error`: 1 at the dofs of bodies and joints that could not be closed while
  /// others were, 0 elsewhere; their part of `constraint_error` is zero, and their whole impulse
  /// belongs to the end of the step. Null: all were closed.
  RCP<Vector> at_end;
};

/// A side of a ConstraintModel whose bodies have midpoint corrections.
class FreeRigidMotion {
 public:
  virtual ~FreeRigidMotion() = default;
  /// Does what `ConstraintModel::close` does, for velocities that were found with `correction`;
  /// `solved` are those before contact changed them. The impulses belong to the motion without
  /// contact, since S1 drops what pushes solids out of one another. Collective.
  virtual ClosedFreeMotion close_free_motion(double time, double dt, const Vector& correction,
                                             const Vector& solved, Vector& velocity) = 0;
};

}  // namespace lockstep
