#pragma once
#include <memory>
#include <string>

#include "coupling/solid_system.hpp"
#include "interfaces/coupling.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Eq. 16 for one fluid, one stack of solids and one coupling, at frozen geometry: the named
/// blocks, right-hand sides, null spaces, and what follows from a solution. Knows none of them
/// beyond their interfaces.
template <int dim>
class CoupledSystem {
 public:
  CoupledSystem(FluidDiscretization<dim>& fluid, SolidSystem<dim>& solids, Coupling<dim>& coupling);

  /// Freezes the geometry at the solids' present positions: cell states, B^T, dM, null spaces.
  /// Collective.
  void freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface);
  const std::shared_ptr<const SurfaceSnapshot<dim>>& surface() const { return surface_; }

  /// The operators for a step of dt (C = M̃_S - dt D); with `with_solid` false A alone, for F2.
  /// Collective.
  const BlockSystem& blocks(double dt, bool with_solid = true);

  /// The solids' D is another one than when `blocks` were asked for last.
  void forget_solid_block() { block_dt_ = -1; }

  /// Row 1: V G_f^T u* + V G_d^T u_d + V G_c^T W_k V_k; row 2: `momentum` + W^T M_F (u*_F - W_k
  /// V_k), locked and padding rows zero. `momentum` = M_S V_S* (+ the viscous impulse); unused
  /// without unknowns. The velocities of locked dofs that move, or null, bring B V_locked to row 1
  /// and -C V_locked, of a step of dt, to row 2; the solution is without them. Incompatible parts
  /// are projected out; `incompatibility` gets their relative size. Collective.
  BlockVector right_hand_side(const Vector& momentum, double& incompatibility, double dt = 0,
                              const RCP<const Vector>& locked_velocity = Teuchos::null) const;
  /// The row 2 of `right_hand_side` before locked rows are zeroed and without their velocities.
  RCP<Vector> lumped_momentum(const Vector& momentum) const;
  /// C V for a step of dt with the rows and columns of locked dofs. Collective.
  RCP<Vector> unlocked_momentum(double dt, const Vector& velocity) const;

  /// A sentence if sides, prescribed solids or locked dofs of these velocities (null: at rest)
  /// change the volume of fluid that is closed in (`impossible_flow`) by more than `negligible`
  /// [m^dim/s]. Collective.
  std::string impossible_flow(double time, const RCP<const Vector>& locked_velocity,
                              double negligible = 0) const;

  /// Impulses that hold the locked dofs, as generalized momentum; zero without locks. Collective.
  RCP<Vector> lock_reaction(double dt, const Vector& momentum, const BlockVector& solution) const;
  /// Momentum of the fluid lumped at mixed faces: sum M_F u. Global. Collective.
  Momentum<dim> lumped_fluid_momentum(const std::vector<double>& coupled_velocity) const;
  double lumped_fluid_energy(const std::vector<double>& coupled_velocity) const;

  const std::vector<RCP<const Vector>>& null_space() const { return blocks_.null_space; }

 private:
  FluidDiscretization<dim>& fluid_;
  SolidSystem<dim>& solids_;
  Coupling<dim>& coupling_;
  std::shared_ptr<const SurfaceSnapshot<dim>> surface_;
  BlockSystem blocks_, pressure_only_;
  RCP<const CrsMatrix> unlocked_transposed_;  ///< B^T with its locked rows
  double block_dt_ = -1;                      ///< the dt of blocks_.solid_block
  bool solid_depends_on_dt_ = false;
};

}  // namespace lockstep
