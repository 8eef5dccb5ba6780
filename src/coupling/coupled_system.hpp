#pragma once
#include <memory>
#include <string>

#include "coupling/solid_system.hpp"
#include "interfaces/coupling.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Eq. 16 for one fluid, one stack of solids and one coupling, at frozen geometry: the
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
  /// C gets J^T K J besides, of contacts that it holds, until the next call or `freeze`; null:
  /// nothing. Collective.
  void hold(const RCP<const CrsMatrix>& stiffness);

  /// Row 1: V G_f^T u* + V G_d^T u_d + V G_c^T W_k V_k + B b; row 2: P^T (`momentum` + W^T M_F
  /// (u*_F
  /// - W_k V_k) - C b) for a step of dt. `momentum` = M_S V_S* (+ the viscous impulse); unused
  /// without unknowns. The solution is y, and V = P y + b. Incompatible parts are projected out;
  /// `incompatibility` gets their relative size. Collective.
  BlockVector right_hand_side(const Vector& momentum, double dt, const Reduction& constraints,
                              double& incompatibility) const;
  /// Makes the right-hand side with given dofs at rest.
  BlockVector right_hand_side(const Vector& momentum, double& incompatibility) const {
    return right_hand_side(momentum, 0, solids_.reduction(), incompatibility);
  }
  /// The row 2 of `right_hand_side` on all dofs, without b.
  RCP<Vector> lumped_momentum(const Vector& momentum) const;
  /// Subtracts the part of a moving b from row 2: row -= C b for a step of dt, with what C holds.
  /// Collective.
  void subtract_given(double dt, const Reduction& constraints, Vector& row) const;

  /// A sentence if sides, prescribed solids or what constraints give change the volume of fluid
  /// that is closed in (`impossible_flow`) by more than `negligible` [m^dim/s]. Collective.
  std::string impossible_flow(double time, const Reduction& constraints,
                              double negligible = 0) const;
  /// A sentence if sides change the volume of closed fluid by more than `negligible` [m^dim/s] and
  /// soft bodies would have to make room for it by their own volume
  /// (`fluid_that_squeezes_solids`). Collective.
  std::string squeezing_flow(double time, double negligible = 0) const;

  /// Impulses of the constraints (`Reduction::keep_reactions`), of a solution with the velocities V
  /// of all dofs. Collective.
  RCP<Vector> reactions(double dt, const Reduction& constraints, const Vector& momentum,
                        const BlockVector& solution) const;
  /// Momentum of the fluid lumped at mixed faces: sum M_F u. Global. Collective.
  Momentum<dim> lumped_fluid_momentum(const std::vector<double>& coupled_velocity) const;
  double lumped_fluid_energy(const std::vector<double>& coupled_velocity) const;

  const NullSpace& null_space() const { return blocks_.null_space; }
  const NullSpace& pressure_null_space() const { return blocks_.pressure_null_space; }
  /// P^T B^T n of all null vectors n of A, if `locks_solids`: impulses to which solids do not
  /// yield, of a pressure that is the same all over closed fluid [m^(dim-1)]. Made once a geometry.
  /// Collective.
  const std::vector<RCP<const Vector>>& locked_directions() const;
  /// Returns d.y for each of these directions d, as `right_hand_side` demands it of the unknowns y
  /// [m^dim/s]. Collective.
  std::vector<double> locked_rates(const Reduction& constraints) const;
  /// True if solids change the volume of closed fluid, which holds them fast along that motion.
  bool locks_solids() const {
    return blocks_.null_space.size() != blocks_.pressure_null_space.size();
  }

 private:
  RCP<Vector> pressure_row(const Reduction& constraints) const;
  void add_given_fluxes(const Reduction& constraints, std::vector<PrescribedFlux>& fluxes) const;

  FluidDiscretization<dim>& fluid_;
  SolidSystem<dim>& solids_;
  Coupling<dim>& coupling_;
  std::shared_ptr<const SurfaceSnapshot<dim>> surface_;
  RCP<const CrsMatrix> coupling_transposed_;  ///< P^T B^T of the geometry; null without solids
  mutable std::vector<RCP<const Vector>> locked_directions_;  ///< empty: not asked for yet
  BlockSystem blocks_, pressure_only_;
  double block_dt_ = 0;               ///< the dt of C in `blocks_`
  unsigned block_linearisation_ = 0;  ///< linearisation number of D in `blocks_`, see SolidSystem
  bool solid_depends_on_dt_ = false;
  bool has_soft_bodies_ = false;
  RCP<const CrsMatrix> held_stiffness_;  ///< J^T K J in the C of `blocks_`; null: none
  bool is_held_anew_ = false;            ///< not yet in C
};

}  // namespace lockstep
