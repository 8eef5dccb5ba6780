#pragma once
#include <string>

#include "coupling/momentum_ledger.hpp"
#include "coupling/reduction.hpp"

namespace lockstep {

/// The stages of a step, as Section 7 names them.
enum class Stage { F1, S1, F2, F3, S2, F4 };

/// What messages and files call it.
inline std::string name_of(Stage stage) {
  constexpr const char* names[] = {"F1", "S1", "F2", "F3", "S2", "F4"};
  return names[static_cast<int>(stage)];
}

/// What joints give where the step begins, found in S1 with how far the bodies go; S2 finds the
/// rest.
struct StartImpulse {
  RCP<const Vector> given;  ///< null: all of what they give acts at the end of the step
  RCP<const Vector> held;   ///< of it, what holds given dofs
};

/// What the parts of a step share: where in the step they are, over which time they act, at which
/// velocities dofs are held meanwhile, and who takes note of the impulses.
template <int dim>
struct StepContext {
  Stage stage = Stage::S2;
  double time = 0;     ///< at which the step begins [s]
  double step_dt = 0;  ///< the whole step [s]
  double dt = 0;       ///< over which this part acts [s]: half of it in F1 and S1
  Reduction constraints;
  MomentumLedger<dim>* ledger = nullptr;  ///< null: this part's impulses are thrown away
  StartImpulse joints = {};               ///< of F3 and S2

  /// F1 and S1 find where the solids go; what they do to momenta and velocities is thrown away.
  bool moves_positions() const { return stage == Stage::F1 || stage == Stage::S1; }
  /// The same with another stage.
  StepContext in(Stage other) const {
    StepContext context = *this;
    context.stage = other;
    return context;
  }
  /// The same, of which nothing is kept.
  StepContext on_trial() const {
    StepContext context = *this;
    context.ledger = nullptr;
    return context;
  }
};

}  // namespace lockstep
