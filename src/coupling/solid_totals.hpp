#pragma once
#include <memory>
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

// Sums, bounds and largest values over all solids of a system.

/// Largest 1-norm of the velocity of a surface vertex, each solid taken as rigid [m/s]. Local.
template <int dim>
double largest_surface_speed(const SolidSystem<dim>& solids);
/// The step that the explicit forces of all models allow.
template <int dim>
StepBound largest_stable_step(const SolidSystem<dim>& solids);

/// True if all models are AuditedSolids.
template <int dim>
bool is_audited(const SolidSystem<dim>& solids);
/// Impulse of external forces between two times. Collective.
template <int dim>
Momentum<dim> external_impulse(const SolidSystem<dim>& solids, double time, double dt);
/// Angular impulse of inner forces, which should be zero [kg m^2/s].
template <int dim>
AngularVector<dim> inner_angular_impulse(const SolidSystem<dim>& solids, double dt);

/// True if any solid that moves is soft: its surface may pass through others and itself between two
/// times at which nothing touches. The same on all ranks. Local.
template <int dim>
bool has_soft_solids(const SolidSystem<dim>& solids);
/// True if any model has nonlinear implicit forces.
template <int dim>
bool has_implicit_forces(const SolidSystem<dim>& solids);
/// The velocities at which the forces of all models are linearised; null if none are.
template <int dim>
RCP<const Vector> linearisation(const SolidSystem<dim>& solids);
/// dt D V: what the implicit forces give in a step. Its sum is zero, but not its torque: forces
/// linearised at x act at x + dt V. Collective.
template <int dim>
RCP<Vector> implicit_impulse(const SolidSystem<dim>& solids, double dt, const Vector& velocity);
/// The models' rigid motions on the map of the system, with the masses M_S + added. Collective.
template <int dim>
NearNullSpace near_null_space(const SolidSystem<dim>& solids, const RCP<const CrsMatrix>& added);
/// The energies of each solid (`NonlinearSolids`). Collective.
template <int dim>
std::vector<ComputedEnergy> nonlinear_energies(const SolidSystem<dim>& solids, double dt,
                                               const Vector& velocity);

/// Number of clamped elements (`SolidOutput`).
template <int dim>
GlobalIndex n_clamped_elements(const SolidSystem<dim>& solids);
/// Stretch beyond the limit in the worst place (`SolidOutput`).
template <int dim>
double stretch_beyond_limit(const SolidSystem<dim>& solids);

/// True if the surfaces of the solids are where this snapshot of them has them, to the last bit.
template <int dim>
bool is_where(const SolidSystem<dim>& solids, const SurfaceSnapshot<dim>& snapshot);
/// Returns an earlier snapshot of the solids with the images of another: itself if it has them.
template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> with_images_of(
    const SolidSystem<dim>& solids, const SurfaceSnapshot<dim>& other,
    const std::shared_ptr<const SurfaceSnapshot<dim>>& earlier);

}  // namespace lockstep
