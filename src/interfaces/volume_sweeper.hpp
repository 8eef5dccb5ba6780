#pragma once
#include <vector>

#include "interfaces/solid.hpp"

namespace lockstep {

/// A side of solid models with nodes: the volume that a surface sweeps in a step can be
/// given. Nodes move on straight lines, and the fluid sees their velocity at its own faces, so that
/// the volume a surface sweeps is not quite the volume that the fluid makes room for. In a closed
/// region the difference has nowhere to go: it adds up to a pressure level and to a loss of volume.
template <int dim>
class VolumeSweeper {
 public:
  virtual ~VolumeSweeper() = default;
  /// True for each solid whose swept volume can be given in the present step: closed solids, and
  /// shells without a free edge, that lie in `domain` and whose surfaces are not attached to solids
  /// of other models. Collective.
  virtual std::vector<char> can_sweep(const Box<dim>& domain) const = 0;
  /// Volume that each solid's surface sweeps along its normals, per velocity of each dof, at the
  /// present positions [m^(dim-1)]: on `dof_map`.
  virtual RCP<const Vector> swept_per_velocity() const = 0;
  /// S1: changes velocities that are about to move the positions by dt so that the surface of each
  /// solid sweeps the given volume [m^dim]; those of nan stay. Shells move along their normals,
  /// closed solids swell about their centre of mass, which stays. Collective.
  virtual void sweep(double dt, const std::vector<double>& volumes, Vector& velocity) const = 0;
};

}  // namespace lockstep
