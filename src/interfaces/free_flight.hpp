#pragma once
#include "interfaces/constraint.hpp"

namespace lockstep {

/// A closed motion between whose begin and end bodies turn as their momenta have it.
struct ClosedFlight : ClosedMotion {
  /// With `drift`: what S1 adds to the momentum in the place of the solids' own
  /// `SolidModel::add_midpoint_correction`, now that the impulses at its begin are known.
  RCP<Vector> correction;
  /// With `drift`: what joints gave beside the reactions that S1 found, at the begin and on the
  /// way; for the momentum of S2.
  RCP<Vector> later_impulse;
  /// With `drift`: 1 at the dofs of bodies and joints of which what is said of a null `drift` is
  /// true, while others were closed; 0 elsewhere. Their part of `drift` is zero. Null: there are
  /// none.
  RCP<Vector> at_end;
};

/// A side of a ConstraintModel whose bodies have midpoint corrections.
class FreeFlight {
 public:
  virtual ~FreeFlight() = default;
  /// As `ConstraintModel::close`, of velocities that were found with `correction`. `solved`: what
  /// they were before contact changed them. Impulses are those of the motion without it, since S1
  /// throws away what pushes solids out of one another. Collective.
  virtual ClosedFlight close_flight(double time, double dt, const Vector& correction,
                                    const Vector& solved, Vector& velocity) = 0;
};

}  // namespace lockstep
