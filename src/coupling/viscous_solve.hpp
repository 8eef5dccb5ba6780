#pragma once
#include "coupling/solid_system.hpp"
#include "coupling/viscous_options.hpp"
#include "interfaces/surface_forces.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

/// Result of the coupled viscous solve.
template <int dim>
struct ViscousResult {
  RCP<Vector> solid_impulse;   ///< j_nu = -dt (K_sf u + K_ss V_S) [kg m/s] on the solid map; null
                               ///< without unknowns
  RCP<Vector> solid_velocity;  ///< V of the solution, which is not kept; null without unknowns
  Momentum<dim> boundary_impulse;  ///< walls and prescribed solids on the fluid, global
  /// Impulse of each prescribed solid on the fluid, part of `boundary_impulse` [kg m/s]; zero for
  /// dynamic solids. Where several share a face, one of them has it all. Global.
  std::vector<Momentum<dim>> prescribed_impulses;
  /// Impulses of the fluid on all solids, if they were asked for. This rank's part.
  std::vector<SurfaceImpulse<dim>> on_surface;
  /// Power that friction turns into heat at the velocities of the solution, less the power of
  /// moving sides and inflows [W]; 0 if it was not asked for.
  double dissipation = 0;
  int iterations = 0;
};

/// Fluid and solids that implicit viscosity couples.
template <int dim>
struct ViscousParts {
  const ViscousSystem<dim>& system;  ///< system of `fluid`
  ViscousFluid<dim>& fluid;
  const SolidSystem<dim>& solids;
  const ViscousCoupling<dim>& coupling;
  RCP<const LinearOperator> solid_block;  ///< the reduced C; null without unknowns
  NearNullSpace near_null_space;          ///< rigid motions of the nodes, for `solid_block`
};

struct ViscousRequest {
  RCP<const Vector> lumped_momentum;  ///< row 2 of all dofs, less C b; null without unknowns
  double dt = 0;                      ///< over which viscosity acts [s]
  const Reduction& constraints;       ///< constraints of the solids' dofs
  const ViscousOptions& options;
  bool with_dissipation = false;
  bool with_places = false;  ///< asks for `ViscousResult::on_surface`
};

/// Implicit viscosity over dt, coupled to the solids: conjugate gradients on
///   [ M_f + dt K_ff   dt K_fs              ] [ u   ]   [ M_f u*                          ]
///   [ dt K_sf         M̃_S - dt D + dt K_ss ] [ V_S ] = [ M_S V_S* + W^T M_F u*_F        ]
/// The fluid keeps u; of the solid only its viscous impulse is used, so that its own forces are not
/// applied twice. Throws SolveError with the numbers if the options' tolerance is not reached.
/// Collective.
template <int dim>
ViscousResult<dim> solve_viscous(const ViscousParts<dim>& parts, const ViscousRequest& request);

}  // namespace lockstep
