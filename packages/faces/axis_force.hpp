#pragma once
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// Excess of the displaced mass on the grid, along one axis. Hydrostatic pressure lifts the volume
/// that the grid takes for a body, which is not quite its own, and at another place. The
/// difference, less the fluid lumped on the body, in masses of fluid: times gravity it is the
/// excess force.
template <int dim>
struct DisplacedExcess {
  int solid = -1;                          ///< closed; index in the snapshot
  int axis = 0;                            ///< axis of the acceleration that multiplies it
  Point<dim> center = Point<dim>::Zero();  ///< the solid's centroid [m]
  double mass = 0;                         ///< at the centroid [kg]
  Point<dim> moment =
      Point<dim>::Zero();  ///< moment of mass about the centroid, across the axis [kg m]
};

/// The generalized force per unit of acceleration along one axis [kg], as entries of the solid map.
struct AxisForce {
  int axis = 0;
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
};

/// Generalized force on a dynamic solid: a rigid body takes the force and its moment, a deformable
/// one the force, over its surface.
template <int dim>
AxisForce force_of(const DisplacedExcess<dim>& excess, const SolidSystem<dim>& solids,
                   const SurfaceSnapshot<dim>& surface);

/// Adds acceleration times dt times the forces to a momentum of the stack. Local.
template <int dim>
void add_forces(const std::vector<AxisForce>& forces, const Point<dim>& acceleration, double dt,
                Vector& momentum);

/// Impulses of these excesses on prescribed solids in dt, one per solid of the snapshot. Local.
template <int dim>
std::vector<Momentum<dim>> impulses_on(std::size_t n_solids,
                                       const std::vector<DisplacedExcess<dim>>& excesses,
                                       const Point<dim>& acceleration, double dt);

}  // namespace lockstep
