#pragma once
#include <functional>

#include "coupling/solid_system.hpp"
#include "interfaces/contact.hpp"
#include "stepping/step/step_context.hpp"

namespace lockstep {

template <int dim>
struct SettledMotion {
  RCP<Vector> velocity;        ///< with contact
  ContactReport<dim> contact;  ///< contact of the last linearisation; empty without it
  bool is_settled =
      true;  ///< false: the forces are not yet those of this velocity, nor the contact
};

/// (M_S - dt D)^-1 with locked rows of the identity. Collective.
template <int dim>
RCP<const LinearOperator> implicit_response(const SolidSystem<dim>& solids, double dt);

/// The answer of joints with stiff springs to what contact and limits do within a step of dt; empty
/// without them: solids answer with their masses.
template <int dim>
ContactResponse joint_response(const SolidSystem<dim>& solids, double dt);

/// A search for the motion of solids: its begin, and what else velocities must fulfil.
struct MotionSearch {
  const Vector& predicted;  ///< velocity of the linearised forces; defines Q
  const Vector& first;      ///< first guess: `predicted`, or what else has been asked of it
  /// Changes the velocities of every linearisation so that they fulfil what is asked besides; null:
  /// nothing is.
  std::function<void(Vector&)> adjust = {};
  /// The `implicit_response` of now, for who has it; null: made when it is needed.
  RCP<const LinearOperator> known_response = {};
};

/// Finds the motion of the solids alone in a solve over dt: with the impulses of the fluid as they
/// are, the velocity that minimises
///
///   Phi(V) = 1/2 V.M_S V - Q.V + potential of the inner forces at the positions that V leads to.
///
/// Linearised forces are its quadratic model. Where that is good, nothing is to be done; where it
/// is not (large turns or strains in one step, of stiff solids above all), Newton's method with
/// steps that must lower Phi finds the minimum, so that no step gives the solids energy.
///
/// `contact` may be null; it holds over the whole step. `momentum`, the explicit one of the solve,
/// changes by that of forces linearised anew. Collective.
template <int dim>
SettledMotion<dim> settle_motion(SolidSystem<dim>& solids, ContactModel<dim>* contact,
                                 const StepContext<dim>& context, const MotionSearch& search,
                                 Vector& momentum);

/// Reduces the changes of velocities by `sweep_volumes` to where they cost each solid little
/// energy, since they would strain stiff ones; undoes them where `settle_motion` has to act.
/// Collective.
template <int dim>
void bound_sweep(const SolidSystem<dim>& solids, double dt, const Vector& before, Vector& velocity);

/// True if the model is good at the velocity that a solve has found. Collective.
template <int dim>
bool is_settled(const SolidSystem<dim>& solids, double dt, const Vector& velocity);

/// The farthest velocity on the way from that of the present linearisation to `velocity`, which a
/// solve has found, whose potential is not far above the model: where to linearise anew.
/// Collective.
template <int dim>
RCP<const Vector> tolerable_velocity(const SolidSystem<dim>& solids, double dt,
                                     const Vector& velocity);

}  // namespace lockstep
