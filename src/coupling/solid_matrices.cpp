// The matrices of the stacked solids.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <numeric>

#include "base/errors.hpp"
#include "coupling/solid_system.hpp"
#include "coupling/stacked_matrix.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/triplet_matrix.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep {

template <int dim>
std::vector<StackedPart> SolidSystem<dim>::parts(double dt) const {
  std::vector<StackedPart> all;
  for (int m = 0; m < n_models(); ++m) {
    if (model(m).dof_map()->getGlobalNumElements() == 0)
      continue;
    const auto force = dt == 0 ? RCP<const LinearOperator>() : model(m).implicit_force(dt);
    all.push_back({model(m).mass(), force, model(m).dof_map(), begin_[m].id, begin_[m].local});
  }
  return all;
}

/// They must exist in the pattern; their value is set by the elimination.
template <int dim>
std::vector<int> SolidSystem<dim>::padding_rows() const {
  std::vector<int> rows(n_padding_);
  std::iota(rows.begin(), rows.end(), static_cast<int>(map_->getNodeNumElements()) - n_padding_);
  return rows;
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::solid_block(const RCP<const CrsMatrix>& added,
                                                        double dt) const {
  const std::vector<StackedPart> parts = this->parts(dt);
  if (!all_assembled(parts))
    return as_thyra(rcp(new StackedOperator(parts, dt, added, map_, {reduction_, padding_rows()})));
  return as_operator(reduction_.reduce(stacked_matrix(parts, dt, added, map_, padding_rows())));
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::full_block(const RCP<const CrsMatrix>& added,
                                                       double dt) const {
  return as_thyra(rcp(new StackedOperator(parts(dt), dt, added, map_)));
}

namespace {
/// The sums of the rows. Collective.
RCP<const LinearOperator> lumped(const LinearOperator& mass, const RCP<const Map>& map) {
  Vector ones(map), sums(map);
  ones.putScalar(1);
  apply(mass, ones, sums);
  const auto values = sums.getData();
  std::vector<Triplet> triplets;
  for (int row = 0; row < values.size(); ++row) {
    const GlobalIndex id = map->getGlobalElement(row);
    triplets.push_back({id, id, values[row]});
  }
  return as_operator(assemble_triplets(std::move(triplets), map, map));
}
}  // namespace

template <int dim>
RCP<const CrsMatrix> SolidSystem<dim>::lumped_block() const {
  std::vector<StackedPart> parts = this->parts(0);
  for (StackedPart& part : parts) {
    const auto matrix = assembled(part.mass);
    if (matrix.is_null() || !has_small_blocks(matrix, largest_dense_block))
      part.mass = lumped(*part.mass, part.map);
  }
  return reduction_.reduce(stacked_matrix(parts, 0, Teuchos::null, map_, padding_rows()));
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::mass_inverse() const {
  std::vector<RCP<const LinearOperator>> masses;
  for (const auto& solid_model : models_)
    masses.push_back(solid_model->mass());
  if (mass_inverse_.is_null() || masses != of_masses_) {
    mass_inverse_ = exact_inverse(solid_block(Teuchos::null, 0), "mass of the solids");
    of_masses_ = std::move(masses);
  }
  return mass_inverse_;
}

template <int dim>
RCP<Vector> SolidSystem<dim>::velocity_of(const Vector& momentum, double dt,
                                          const Reduction& constraints,
                                          const LinearOperator& inverse) const {
  Vector rest(momentum, Teuchos::Copy);
  if (!constraints.offset().is_null())
    apply(*full_block(Teuchos::null, dt), *constraints.offset(), rest, -1, 1);
  constraints.restrict(rest);
  const auto velocity = make_vector(map_);
  apply(inverse, rest, *velocity);
  constraints.expand(*velocity);
  return velocity;
}

template <int dim>
RCP<Vector> SolidSystem<dim>::velocity_of(const Vector& momentum, double dt,
                                          const Reduction& constraints) const {
  if (dt == 0)
    return velocity_of(momentum, dt, constraints, *mass_inverse());
  const auto inverse = exact_inverse(solid_block(Teuchos::null, dt), "implicit forces of solids");
  return velocity_of(momentum, dt, constraints, *inverse);
}

template RCP<const LinearOperator> SolidSystem<2>::solid_block(const RCP<const CrsMatrix>&,
                                                               double) const;
template RCP<const LinearOperator> SolidSystem<2>::full_block(const RCP<const CrsMatrix>&,
                                                              double) const;
template RCP<const CrsMatrix> SolidSystem<2>::lumped_block() const;
template RCP<const LinearOperator> SolidSystem<2>::mass_inverse() const;
template RCP<Vector> SolidSystem<2>::velocity_of(const Vector&, double, const Reduction&,
                                                 const LinearOperator&) const;
template RCP<Vector> SolidSystem<2>::velocity_of(const Vector&, double, const Reduction&) const;
template RCP<const LinearOperator> SolidSystem<3>::solid_block(const RCP<const CrsMatrix>&,
                                                               double) const;
template RCP<const LinearOperator> SolidSystem<3>::full_block(const RCP<const CrsMatrix>&,
                                                              double) const;
template RCP<const CrsMatrix> SolidSystem<3>::lumped_block() const;
template RCP<const LinearOperator> SolidSystem<3>::mass_inverse() const;
template RCP<Vector> SolidSystem<3>::velocity_of(const Vector&, double, const Reduction&,
                                                 const LinearOperator&) const;
template RCP<Vector> SolidSystem<3>::velocity_of(const Vector&, double, const Reduction&) const;

}  // namespace lockstep
