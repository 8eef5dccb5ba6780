#pragma once
#include <optional>
#include <vector>

#include "deformable/body_turn.hpp"
#include "deformable/element_forces.hpp"
#include "interfaces/solid_sides.hpp"

namespace lockstep {

/// The place on its way at which a step takes the forces, and D(dt), their part in the solve.
///
/// Explicit elastic forces are those at the present positions. Implicit ones make, for one mode of
/// stiffness m omega^2 and a = omega dt, b = 1 + a^2/2, together with the step the map
/// x' = (x + (1 + c a^2) dt v)/b, v' = (v - dt omega^2 x')/(1 + a^2), whose energy falls by 3/2 a^2
/// of itself a step. Second order has v' = (v - dt omega^2 x)/(1 + a^2/2), the force at
/// x + v' dt/2; its energy falls by a^4/8 where a is small. c is 1/4, of second order 1/8, where
/// the step resolves the motion and 0 where it does not: see add_midpoint_correction. Explicit and
/// semi-implicit are stable up to a = sqrt 2.
template <int dim>
class ImplicitForces : public NonlinearSolids<dim> {
 public:
  using Nodes = std::vector<Point<dim>>;
  /// All must outlive it.
  ImplicitForces(const BodyNodes<dim>& nodes, const BodyTurn<dim>& turn,
                 ElementForces<dim>& forces);

  /// True if any body's elasticity is implicit.
  bool any() const;
  /// True between the moves of positions and the end of the step: the coming solve is S2.
  bool has_moved() const { return moved_; }
  /// Time after which the elastic forces of the coming solve are taken, as a part of the solve's dt
  /// [1]: in S1 the end of the step, two halves of it, in S2 its end or its middle; 0 where D has
  /// no elasticity.
  double share(const SoftBody& body) const;
  /// D(dt): a CrsMatrix, or null if all bodies are explicit. Collective.
  RCP<const LinearOperator> implicit_force(double dt) const;
  void add_midpoint_correction(double dt, Vector& momentum) const;

  /// Bounds the frequencies of the bodies by the forces at the start. Collective.
  void bound_frequencies();
  /// Softens the bodies that a step of dt cannot resolve but for what holds them. Collective.
  void soften(double dt, const std::vector<char>& is_free);
  /// Forces of the coming S1 where bodies that turn will be after the step, strained as they are.
  /// Collective.
  void look_ahead();
  /// Positions have moved away from `before`, all local nodes', in a step of dt; `update` follows.
  void moved(Nodes before, double dt);
  /// Forces at the present positions; for second-order bodies that have moved, those of S2.
  /// Collective.
  void update();
  /// Forces of the next S1; `changed`: they have changed at the present positions. Collective.
  void end_step(bool changed = false);

  void linearise(double dt, const Vector& velocity) override;
  RCP<const Vector> linearisation() const override { return linearisation_; }
  std::vector<ComputedEnergy> nonlinear_energies(double dt, const Vector& velocity) const override;

 private:
  double share_at(int node) const { return share(nodes_.body(node)); }
  /// Positions of all local nodes to which these velocities of theirs lead.
  Nodes reached(double dt, const Nodes& velocity) const;
  void assemble(const Nodes& x);

  const BodyNodes<dim>& nodes_;
  const BodyTurn<dim>& turn_;
  ElementForces<dim>& forces_;
  std::vector<double> stiffest_rate_;  ///< bounds of the bodies' frequencies at the start [1/s]
  mutable RCP<const LinearOperator> implicit_force_;  ///< null: not asked for yet
  mutable double implicit_force_dt_ = 0;              ///< [s]
  /// Positions at the start of the step [m], from `moved` to the end of the step, if bodies are of
  /// second order. Null on all ranks or on none, with nodes or without.
  std::optional<Nodes> before_;
  double moved_dt_ = 0;  ///< length of that step [s]
  Nodes beside_;         ///< ways of bodies that turn beside those straight on [m]; or empty
  bool moved_ = false;
  bool linearised_ = false;          ///< elsewhere than at the present positions
  RCP<const Vector> linearisation_;  ///< the velocity that leads there; null: zero
};

}  // namespace lockstep
