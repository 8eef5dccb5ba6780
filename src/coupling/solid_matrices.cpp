// The matrices of the stacked solids.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <numeric>

#include "base/errors.hpp"
#include "coupling/solid_system.hpp"
#include "coupling/stacked_matrix.hpp"
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

/// Attached nodes' entries go to the solids that carry them.
template <int dim>
RCP<CrsMatrix> SolidSystem<dim>::reduced_matrix(const std::vector<StackedPart>& parts, double dt,
                                                const RCP<const CrsMatrix>& added) const {
  std::vector<Triplet> triplets = stacked_triplets(parts, dt);
  attachments_.reduce(triplets, *map_);
  if (!added.is_null())
    add_triplets(*added, 0, 1, triplets);
  for (const int row : padding_rows()) {
    const GlobalIndex id = map_->getGlobalElement(row);
    triplets.push_back({id, id, 1});
  }
  return assemble_triplets(std::move(triplets), map_, map_);
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::block(const RCP<const CrsMatrix>& added, double dt,
                                                  bool eliminate) const {
  const std::vector<StackedPart> parts = this->parts(dt);
  if (!all_assembled(parts)) {
    check_input(
        attachments_.empty(),
        "Nodes can only be attached to solids whose mass and forces are assembled matrices.");
    return as_thyra(
        rcp(new StackedOperator(parts, dt, added, eliminate ? free_mask_ : Teuchos::null, map_)));
  }
  const RCP<CrsMatrix> matrix = attachments_.empty()
                                    ? stacked_matrix(parts, dt, added, map_, padding_rows())
                                    : reduced_matrix(parts, dt, added);
  if (eliminate && has_locks_)
    eliminate_masked(*matrix, *free_mask_);
  return as_operator(matrix);
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::solid_block(const RCP<const CrsMatrix>& added,
                                                        double dt) const {
  return block(added, dt, true);
}

template <int dim>
NearNullSpace SolidSystem<dim>::near_null_space(const RCP<const CrsMatrix>& added) const {
  constexpr int n_motions = dim + n_rotations<dim>;
  NearNullSpace all;
  RCP<MultiVector> motions;
  for (int m = 0; m < n_models(); ++m) {
    const auto* known = side<NearNullSpaces<dim>>(m);
    const NearNullSpace part = known ? known->near_null_space() : NearNullSpace();
    if (part.empty())
      continue;
    if (motions.is_null()) {
      motions = rcp(new MultiVector(map_, n_motions));
      all.body_of_row.assign(map_->getNodeNumElements(), -1);
    }
    motions->offsetViewNonConst(model(m).dof_map(), begin_[m].local)->update(1, *part.motions, 0);
    for (std::size_t row = 0; row < part.body_of_row.size(); ++row)
      all.body_of_row[begin_[m].local + row] = all.n_bodies + part.body_of_row[row];
    all.n_bodies += part.n_bodies;
  }
  all.motions = motions;
  if (all.empty())
    return all;
  const auto mass = lumped_mass(
      *as_thyra(rcp(new StackedOperator(parts(0), 0, added, Teuchos::null, map_))), all);
  const auto values = mass->getDataNonConst();
  const auto is_free = free_mask_->getData();
  for (std::size_t row = 0; row < all.body_of_row.size(); ++row) {
    if (all.body_of_row[row] >= 0 && is_free[row] == 0)
      values[row] = 1;
  }
  all.mass = mass;
  return all;
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::unlocked_block(const RCP<const CrsMatrix>& added,
                                                           double dt) const {
  if (!attachments_.empty())
    return block(added, dt, false);
  return as_thyra(rcp(new StackedOperator(parts(dt), dt, added, Teuchos::null, map_)));
}

template <int dim>
RCP<const LinearOperator> SolidSystem<dim>::mass() const {
  return unlocked_block(Teuchos::null, 0);
}

template <int dim>
RCP<Vector> SolidSystem<dim>::velocity_of(const Vector& generalized_momentum) const {
  const auto velocity = make_vector(map_);
  apply(*exact_inverse(block(Teuchos::null, 0, false), "mass of the solids"), generalized_momentum,
        *velocity);
  return velocity;
}

template RCP<const LinearOperator> SolidSystem<2>::solid_block(const RCP<const CrsMatrix>&,
                                                               double) const;
template NearNullSpace SolidSystem<2>::near_null_space(const RCP<const CrsMatrix>&) const;
template RCP<const LinearOperator> SolidSystem<2>::unlocked_block(const RCP<const CrsMatrix>&,
                                                                  double) const;
template RCP<const LinearOperator> SolidSystem<2>::mass() const;
template RCP<Vector> SolidSystem<2>::velocity_of(const Vector&) const;
template RCP<const LinearOperator> SolidSystem<3>::solid_block(const RCP<const CrsMatrix>&,
                                                               double) const;
template NearNullSpace SolidSystem<3>::near_null_space(const RCP<const CrsMatrix>&) const;
template RCP<const LinearOperator> SolidSystem<3>::unlocked_block(const RCP<const CrsMatrix>&,
                                                                  double) const;
template RCP<const LinearOperator> SolidSystem<3>::mass() const;
template RCP<Vector> SolidSystem<3>::velocity_of(const Vector&) const;

}  // namespace lockstep
