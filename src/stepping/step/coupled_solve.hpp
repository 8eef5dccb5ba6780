#pragma once
#include "coupling/coupled_system.hpp"
#include "output/timers.hpp"
#include "stepping/step/implicit_motion.hpp"
#include "stepping/step/locked_motions.hpp"
#include "stepping/step/solid_forces.hpp"
#include "stepping/step/trapped_gas.hpp"

namespace lockstep {

struct CoupledSolveOptions {
  double tolerance = 1e-8;    ///< largest residual of each block, relative [1]
  int newton_iterations = 1;  ///< solves with implicit forces linearised anew
};

/// Velocities with their contacts.
template <int dim>
struct MotionWithContacts {
  CoupledSolution solution;
  ContactReport<dim> contact;
  RCP<const Vector> contact_impulse{};  ///< generalized, of all contacts and limits; null: none
  RCP<const Vector> free_velocity{};    ///< V without the contacts held, in their response R
  bool is_settled = true;  ///< false: what closed fluid and contacts ask for has no solution
};

/// Finds p̂ and V of Eq. 16 at frozen geometry, with implicit forces of solids, gas and contact.
template <int dim>
class CoupledSolve {
 public:
  /// Throws InputError if the fluid has gas that the coupling does not know.
  CoupledSolve(Components<dim>& components, CoupledSystem<dim>& system,
               const CoupledSolveOptions& options, StageTimers& timers);

  /// One linear solve with the explicit `momentum` M_S V_S*; `name` is for messages. It begins at
  /// `nearby`, the unknowns of a similar solve; null: at the last step's. Throws SolveError.
  /// Collective.
  CoupledSolution solve(const StepContext<dim>& context, const RCP<Vector>& momentum,
                        const std::string& name, const BlockVector* nearby = nullptr);
  /// As `solve`, with implicit forces that are those at the velocity found: Newton's method, and
  /// where velocities are found also a search that lowers the energy. `momentum` changes with the
  /// linearisation. Collective.
  CoupledSolution converge(const StepContext<dim>& context, const RCP<Vector>& momentum,
                           const BlockVector* nearby = nullptr);
  /// True if contacts, and limits of joints, are part of the coupled solve, wherever that settles;
  /// ranks agree.
  bool holds_contacts() const;
  /// Returns the contacts of the velocities that solids with `momentum` have if the fluid gives
  /// them what it gives at rest, or gave soft ones in the last step, in the response of
  /// `contact_response`. Collective.
  ContactReport<dim> expected_contacts(const StepContext<dim>& context, const Vector& momentum,
                                       const ContactResponse& response);
  /// The response of solids to impulses, with the fluid on them. Collective.
  ContactResponse contact_response(double dt) const;
  /// Puts J^T K J of these contacts into the system, and adds J^T (l + K b) to the momentum;
  /// without contacts the system holds none. Collective.
  void hold(const ContactReport<dim>& contacts, Vector& momentum);
  /// Solves for velocities that keep contacts (docs/method.md, "Contact in the coupled system"):
  /// held as rows of C, for which the contact model decides. `nearby`: see `solve`. Collective.
  MotionWithContacts<dim> solve_with_contacts(const StepContext<dim>& context,
                                              const RCP<const Vector>& momentum,
                                              const BlockVector* nearby = nullptr);
  /// `solve_with_contacts` as `converge` does `solve`. Collective.
  MotionWithContacts<dim> converge_with_contacts(const StepContext<dim>& context,
                                                 const RCP<Vector>& momentum,
                                                 const BlockVector* nearby = nullptr);
  /// The reactions of constraints (`Reduction::keep_reactions`) to the contacts that a motion
  /// holds, by their response R. Collective.
  RCP<Vector> reactions_to_contacts(const StepContext<dim>& context,
                                    const MotionWithContacts<dim>& motion) const;
  /// The end of the step. `drag`: viscous impulse on the solids; null: none; `nearby`: see `solve`.
  /// Throws SolveError if what is prescribed has no solution, but for what the grid makes of the
  /// solids' shapes. Collective.
  MotionWithContacts<dim> velocities(const StepContext<dim>& context,
                                     const SolidMomentum<dim>& solids,
                                     const RCP<const Vector>& drag,
                                     const BlockVector* nearby = nullptr);
  /// u* -= M^-1 G p, and u*_F = W V; `viscous_pressure`: what the pressure for the next step has
  /// besides; null: nothing. Collective.
  void project(const CoupledSolution& solution, const RCP<const Vector>& viscous_pressure);
  /// u^{n+1} = u*, V^{n+1} = V, and joints take note of what they gave; `reactions`: of constraints
  /// in the solve. Collective.
  void accept(const StepContext<dim>& context, const MotionWithContacts<dim>& end,
              const RCP<const Vector>& reactions);

 private:
  bool improve(const StepContext<dim>& context, int n_solves, CoupledSolution& solution,
               Vector& momentum);
  RCP<Vector> expected_impulse(const StepContext<dim>& context, const Vector& momentum,
                               const Vector& velocity) const;
  void solve_held(const StepContext<dim>& context, const Vector& momentum,
                  const BlockVector* nearby, const LockedMotions& locked,
                  MotionWithContacts<dim>& motion);
  ContactReport<dim> compare(const StepContext<dim>& context, const ContactResponse& response,
                             MotionWithContacts<dim>& motion, double& scale);
  void release(const StepContext<dim>& context, MotionWithContacts<dim>& motion);
  ContactReport<dim> decide(const StepContext<dim>& context, const ContactResponse& response,
                            Vector& velocity);

  Components<dim>& components_;
  CoupledSystem<dim>& system_;
  CoupledSolveOptions options_;
  TrappedGas<dim> gas_;
  StageTimers& timers_;
};

}  // namespace lockstep
