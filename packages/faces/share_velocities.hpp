#pragma once
#include "faces/surface_shares.hpp"

namespace lockstep {

/// Velocities of the single shares of coupled volumes, for impulses share by share.
template <int dim>
class ShareVelocities {
 public:
  /// `import` brings the dofs of all shares that are asked for; `velocity` is that of all dofs
  /// [m/s]. The solids must outlive it. Collective.
  ShareVelocities(const SolidSystem<dim>& solids, const Import& import, const Vector& velocity);

  /// The velocity along an axis of a surface point of a solid that is not prescribed, of a rigid
  /// one at x, without local rotations [m/s]. Local.
  double along(int direction, const SurfacePoint<dim>& point, const Point<dim>& x);

 private:
  const SolidSystem<dim>& solids_;
  Vector velocity_;  ///< on the dofs of this rank's shares
  DirectedRow<dim> row_;
};

}  // namespace lockstep
