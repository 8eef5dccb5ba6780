// Strain limiting in the step: velocities before they move the positions.
#include <Tpetra_Vector.hpp>

#include "deformable/deformable_solids.hpp"

namespace lockstep {

template <int dim>
void DeformableSolids<dim>::make_strain_limit(const std::vector<DeformableBody<dim>>& bodies) {
  std::vector<LimitedEdge> edges;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (LimitedEdge edge : bodies[b].limited_edges) {
      for (int& corner : edge.corners)
        corner += bodies_[b].node_begin;
      edges.push_back(edge);
    }
  }
  strain_limit_ = StrainLimit<dim>(edges, space_, comm_->getRank());
}

/// Returns one over the mass along each axis; zero for nodes that are held or carried.
template <int dim>
typename DeformableSolids<dim>::Nodes DeformableSolids<dim>::mobility() const {
  Nodes inverse(space_.n_owned());
  for (int i = 0; i < space_.n_owned(); ++i)
    inverse[i].setConstant(node_mass_[i] > 0 ? 1 / node_mass_[i] : 0);
  for (const int dof : held_.dofs())
    inverse[dof / dim][dof % dim] = 0;
  for (const auto& attached : attached_)
    inverse[attached.first].setZero();
  return inverse;
}

/// The impulses enter the momentum of S2 as well: they sum to zero on every edge.
template <int dim>
void DeformableSolids<dim>::limit_motion(double dt, Vector& velocity) {
  if (strain_limit_.empty())
    return;
  const Nodes inverse = space_.with_ghosts(*space_.vector(mobility()));
  Nodes limited = space_.with_ghosts(velocity);
  limiting_impulse_.assign(space_.n_local(), Point<dim>::Zero());
  stretch_beyond_limit_ =
      strain_limit_.apply(x_, inverse, dt, space_, comm_, limited, limiting_impulse_);
  velocity.update(1, *space_.vector(limited), 0);
}

template void DeformableSolids<2>::make_strain_limit(const std::vector<DeformableBody<2>>&);
template void DeformableSolids<3>::make_strain_limit(const std::vector<DeformableBody<3>>&);
template std::vector<Point<2>> DeformableSolids<2>::mobility() const;
template std::vector<Point<3>> DeformableSolids<3>::mobility() const;
template void DeformableSolids<2>::limit_motion(double, Vector&);
template void DeformableSolids<3>::limit_motion(double, Vector&);

}  // namespace lockstep
