#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "coupling/spin_couples.hpp"
#include "interfaces/surface_forces.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

/// All viscous links of this rank: link l pulls with c_l (u_row(l) - (L V)_l - prescribed_l) on
/// fluid and solid; the couples of the transposed gradient come to the solid's end.
template <int dim>
class ViscousCouplings {
 public:
  /// `system` must outlive it. `with_places`: for `impulses_on_solids`. Collective.
  ViscousCouplings(const ViscousSystem<dim>& system, const SolidSystem<dim>& solids,
                   const ViscousCoupling<dim>& coupling, bool with_places = false);

  /// Velocities of the ends [m/s] for solid velocities V (null: none), prescribed velocities in or
  /// out. Collective.
  RCP<Vector> end_velocity(const RCP<const Vector>& solid, bool prescribed) const;
  /// Pulls of the couplings [N] for fluid velocities u. Local.
  RCP<Vector> pull(const Vector& u, const Vector& end_velocity) const;
  /// The couples as forces on the solids [N]. Collective.
  RCP<Vector> couple_pull(const Vector& end_velocity) const;
  /// Adds the couples to the pulls of the couplings. Collective.
  void add_couples(const Vector& end_velocity, Vector& pull) const;
  /// fluid -= dt values, each link's in its row; `values` are per link and, with `weighted`, times
  /// its coefficient. Local.
  void take_from_fluid(double dt, const Vector& values, bool weighted, Vector& fluid) const;
  /// drag = alpha L^T pull + beta drag on the solid map. Only with unknowns. Collective.
  void pull_on_solids(double alpha, const Vector& pull, double beta, Vector& drag) const;
  /// Dissipation beside that of K_ff's diagonal: sum c (v^2 - 2 u v) over the velocities v of the
  /// ends, and that of the couples [W]. This rank's part.
  double dissipation(const Vector& u, const Vector& end_velocity, const Vector& couple_pull) const;
  /// Contribution of the viscous couplings to the diagonal of the solids' rows, sum c L^2 [kg/s].
  /// Collective.
  RCP<Vector> strength_on_solids() const;

  /// Impulse of the couplings whose two ends lie apart across their direction, which is a couple,
  /// with the couple of the transposed gradient, which cancels it and that of the fluid's own
  /// couplings. `of_prescribed` gets the impulse of each prescribed solid on the fluid. This rank's
  /// part.
  Momentum<dim> impulse(const Vector& pull, const Vector& couple_pull, double dt,
                        std::vector<Momentum<dim>>& of_prescribed) const;
  /// Impulses on all solids over dt, place by place, couples included. Where several prescribed
  /// solids share an end, one of them has it all, as in `impulse`. This rank's part.
  std::vector<SurfaceImpulse<dim>> impulses_on_solids(const Vector& pull, const Vector& couple_pull,
                                                      double dt) const;

 private:
  static std::vector<EndVelocity<dim>> ends_of(const ViscousSystem<dim>& system,
                                               const SolidSystem<dim>& solids,
                                               const ViscousCoupling<dim>& coupling);

  const std::vector<ViscousCouplingTerm<dim>>& list_;
  std::vector<EndVelocity<dim>> ends_;  ///< dofs, weights, perhaps shares emptied once assembled
  SpinCouples<dim> couples_;
  RCP<const Map> map_;            ///< links
  RCP<const CrsMatrix> rows_;     ///< L: links x solid dofs; null without unknowns
  RCP<const CrsMatrix> squares_;  ///< entries squared, for the diagonal
};

}  // namespace lockstep
