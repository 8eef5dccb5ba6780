#pragma once
#include <vector>

#include "deformable/body_turn.hpp"
#include "deformable/nodal_surface.hpp"
#include "interfaces/volume_sweeper.hpp"

namespace lockstep {

/// Volumes that the surfaces of deformable bodies sweep in S1. Bodies that turn along arcs are left
/// out: straight steps add nothing to them.
template <int dim>
class VolumeSweep : public VolumeSweeper<dim> {
 public:
  using Nodes = std::vector<Point<dim>>;
  /// All must outlive it; `states` are those of the bodies. Local.
  VolumeSweep(const BodyNodes<dim>& nodes, const NodalSurface<dim>& surface,
              const std::vector<SolidState<dim>>& states, const BodyTurn<dim>& turn);

  std::vector<char> can_sweep(const Box<dim>& domain) const override;
  RCP<const Vector> swept_per_velocity() const override;
  void sweep(double dt, const std::vector<double>& volumes, Vector& velocity) const override;

 private:
  std::vector<char> free_boundary_nodes() const;
  Nodes area_shares() const;
  Nodes swelling() const;

  const BodyNodes<dim>& nodes_;
  const NodalSurface<dim>& surface_;
  const std::vector<SolidState<dim>>& states_;
  const BodyTurn<dim>& turn_;
  std::vector<int> boundary_nodes_;  ///< owned ones, where shells end
};

}  // namespace lockstep
