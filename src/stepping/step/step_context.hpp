#pragma once
#include <string>

#include "coupling/reduction.hpp"

namespace lockstep {

/// A step among the steps of a run.
struct StepTime {
  double begin = 0;      ///< [s]
  double dt = 0;         ///< [s]
  double last_dt = 0;    ///< length of the step before [s]; 0: there is none
  long long number = 1;  ///< from 1 on, as in history.csv

  double end() const { return begin + dt; }
};

/// The impulses of joints that act where the step begins, found with the motion of the solids; the
/// solve for the velocities finds the rest. Generalized.
struct StartImpulse {
  RCP<const Vector> given;  ///< null: all of what they give acts at the end of the step
  RCP<const Vector> held;   ///< part of the impulses that holds given dofs
};

/// Context of the stages that lead to one coupled solve: the step, the time over which they act,
/// and the velocities at which dofs are held meanwhile.
template <int dim>
struct StepContext {
  StepTime step;
  std::string solve;  ///< name of the coupled solve in messages and files
  double begin = 0;   ///< time from which these stages act [s]
  double dt = 0;      ///< over which these stages act [s]
  /// They find where the solids go: their impulses and velocities are thrown away.
  bool moves_positions = false;
  Reduction constraints;
  StartImpulse joints = {};  ///< where velocities are found
  bool takes_drops = true;   ///< impulses of drops on solids in the last transport act here
};

}  // namespace lockstep
