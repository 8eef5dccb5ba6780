#include "faces/hydrostatic_force.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <numeric>

#include "linear/matrix_sum.hpp"

namespace lockstep {

namespace {

/// The displaced mass of soft solids, on the nodes of their surfaces by area, but on dofs on which
/// fluid is lumped. Local.
template <int dim>
std::vector<Triplet> added_mass_of_nodes(const std::vector<DisplacedMass<dim>>& displaced,
                                         const SolidSystem<dim>& solids,
                                         const SurfaceSnapshot<dim>& surface,
                                         const RCP<const CrsMatrix>& lumped) {
  Vector on_dofs(solids.map());
  if (!lumped.is_null())
    lumped->getLocalDiagCopy(on_dofs);
  const auto has_fluid = on_dofs.getData();
  std::vector<Triplet> triplets;
  VelocityRow<dim> row;
  for (const DisplacedMass<dim>& one : displaced) {
    const SolidDescription& solid = surface.solids()[one.solid];
    if (solid.rigid || solid.prescribed)
      continue;
    std::vector<double> areas;
    for (int simplex = solid.simplex_begin; simplex < solid.simplex_end; ++simplex)
      areas.push_back(area_vector<dim>(surface.corners(simplex)).norm());
    const double whole = std::accumulate(areas.begin(), areas.end(), 0.0);
    for (int simplex = solid.simplex_begin; simplex < solid.simplex_end; ++simplex) {
      SurfacePoint<dim> corner;
      corner.simplex = simplex;
      for (int k = 0; k < dim; ++k) {
        corner.barycentric.setZero();
        corner.barycentric[k] = 1;
        solids.velocity_row(corner, surface.corners(simplex)[k], row);
        const double mass = one.mass * areas[simplex - solid.simplex_begin] / (dim * whole);
        for (std::size_t i = 0; i < row.dofs.size(); ++i) {
          const int local = solids.map()->getLocalElement(row.dofs[i]);
          if (local >= 0 && has_fluid[local] == 0)
            triplets.push_back(
                {row.dofs[i], row.dofs[i], mass * row.coefficients[i].squaredNorm()});
        }
      }
    }
  }
  return triplets;
}

}  // namespace

template <int dim>
void HydrostaticForce<dim>::reset(const SurfaceSnapshot<dim>& surface) {
  surface_ = &surface;
  solids_ = nullptr;
  at_rest_.clear();
  corrections_.clear();
  displaced_masses_.clear();
}

template <int dim>
void HydrostaticForce<dim>::take(const HydrostaticLoads<dim>& loads,
                                 const SolidSystem<dim>& solids) {
  solids_ = &solids;
  at_rest_ = loads.on_grid();
  corrections_ = loads.corrections();
  displaced_masses_ = loads.displaced_masses();
}

template <int dim>
std::vector<Momentum<dim>> HydrostaticForce<dim>::add_hydrostatic_force(double dt,
                                                                        Vector& momentum) const {
  if (corrections_.empty())
    return std::vector<Momentum<dim>>(surface_->solids().size());
  add_loads<dim>(corrections_, *solids_, *surface_, dt, momentum);
  return impulses_on_prescribed<dim>(corrections_, *surface_, dt);
}

template <int dim>
void HydrostaticForce<dim>::add_impulse_at_rest(double dt, Vector& momentum) const {
  if (!at_rest_.empty())
    add_loads<dim>(at_rest_, *solids_, *surface_, dt, momentum);
}

template <int dim>
RCP<const CrsMatrix> HydrostaticForce<dim>::mass_with_fluid(
    const SolidSystem<dim>& solids, const RCP<const CrsMatrix>& lumped) const {
  if (displaced_masses_.empty())
    return lumped;
  std::vector<Triplet> triplets = added_mass_of_balls<dim>(displaced_masses_, solids, *surface_);
  for (const Triplet& one : added_mass_of_nodes<dim>(displaced_masses_, solids, *surface_, lumped))
    triplets.push_back(one);
  const RCP<const CrsMatrix> displaced =
      assemble_triplets(std::move(triplets), solids.map(), solids.map());
  if (lumped.is_null())
    return displaced;
  return sum_of({{lumped}, {displaced}}, solids.map());
}

template class HydrostaticForce<2>;
template class HydrostaticForce<3>;

}  // namespace lockstep
