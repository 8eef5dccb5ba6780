#pragma once
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// A force on a closed solid along one axis, with its moment.
template <int dim>
struct AxisLoad {
  int solid = -1;  ///< index in the snapshot
  int axis = 0;
  Point<dim> center = Point<dim>::Zero();  ///< where the force acts [m]
  double force = 0;                        ///< [N]
  Point<dim> moment =
      Point<dim>::Zero();  ///< sum of (x - center) times forces, across the axis [N m]
};

/// Adds dt times the loads to the momentum of the stack [kg m/s]; loads on prescribed solids are
/// left out. A rigid body takes force and moment, a deformable one the force, spread over its
/// surface. All ranks have the same loads. Local.
template <int dim>
void add_loads(const std::vector<AxisLoad<dim>>& loads, const SolidSystem<dim>& solids,
               const SurfaceSnapshot<dim>& surface, double dt, Vector& momentum);

/// Returns the impulses of the loads on prescribed solids over dt, one for each solid of the
/// snapshot, zero for those that are free to move. Local.
template <int dim>
std::vector<Momentum<dim>> impulses_on_prescribed(const std::vector<AxisLoad<dim>>& loads,
                                                  const SurfaceSnapshot<dim>& surface, double dt);

}  // namespace lockstep
