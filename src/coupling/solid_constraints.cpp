// Constraints of the stacked solids: the dofs that follow others, and their motion.
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// Nodes that are attached stay so; where they are, and what is locked, changes.
template <int dim>
void SolidSystem<dim>::find_reduction() {
  std::vector<Combination> combinations;
  if (std::any_of(carried_.begin(), carried_.end(), [](char any) { return any != 0; })) {
    std::string none;
    attached_ = find_attached_nodes(models_, begin_, solids_, none);
    combinations = combinations_of(attached_, models_, begin_, solids_);
  }
  if (joints_) {
    for (Combination& combination : joints_->combinations()) {
      if (map_->isNodeGlobalElement(combination.dof))
        combinations.push_back(std::move(combination));
    }
  }
  std::vector<GlobalIndex> locked;
  for (int m = 0; m < n_models(); ++m) {
    for (const GlobalIndex id : model(m).locked_dofs())
      locked.push_back(begin_[m].id + id);
  }
  Reduction found(map_, std::move(combinations), std::move(locked));
  const bool may_stay = !found.has_combinations() && !reduction_.has_combinations();
  if (!may_stay || found.differs_in_unknowns(reduction_))
    mass_inverse_ = Teuchos::null;
  reduction_ = std::move(found);
}

template <int dim>
void SolidSystem<dim>::set_gravity(const Point<dim>& gravity) {
  for (const auto& solid_model : models_)
    solid_model->set_gravity(gravity);
}

template <int dim>
bool SolidSystem<dim>::begin_step(double time, double dt) {
  for (const auto& solid_model : models_)
    solid_model->begin_step(time, dt);
  ++linearisation_number_;
  const Reduction before = reduction_;
  find_reduction();
  return reduction_.differs_in_unknowns(before);
}

template <int dim>
Reduction SolidSystem<dim>::constraints(double begin, double end,
                                        const RCP<const Vector>& constraint_error) const {
  if (!reduction_.has_given() && constraint_error.is_null())
    return reduction_;
  const auto velocity = constraint_error.is_null()
                            ? make_vector(map_)
                            : rcp(new Vector(*constraint_error, Teuchos::Copy));
  for (int m = 0; m < n_models(); ++m) {
    const std::vector<GlobalIndex> dofs = model(m).locked_dofs();
    const std::vector<double> values = model(m).locked_velocities(begin, end);
    for (std::size_t k = 0; k < dofs.size(); ++k)
      velocity->replaceGlobalValue(begin_[m].id + dofs[k], values[k]);
  }
  return reduction_.with_velocity(velocity);
}

template <int dim>
void SolidSystem<dim>::move(const Vector& velocity, double time, double dt) {
  for (int m = 0; m < n_models(); ++m) {
    if (!carried_[m])
      model(m).move(*part(velocity, m), time, dt);
  }
  if (reduction_.has_combinations())
    move_attached(velocity, time, dt);
  ++linearisation_number_;
}

/// Attached nodes go where their solids have carried them, round the arc of a rotation.
template <int dim>
void SolidSystem<dim>::move_attached(const Vector& velocity, double time, double dt) {
  Vector full(velocity, Teuchos::Copy);
  for (const AttachedNode<dim>& node : attached_) {
    const SolidDescription& solid = solids_[node.solid];
    const Point<dim> target = model(solid.model).carried(solid.index_in_model, node.position);
    for (int a = 0; a < dim; ++a)
      full.replaceGlobalValue(node.dofs[a], (target[a] - node.position[a]) / dt);
  }
  for (int m = 0; m < n_models(); ++m) {
    if (carried_[m])
      model(m).move(*part(std::as_const(full), m), time, dt);
  }
  find_reduction();
}

template void SolidSystem<2>::find_reduction();
template void SolidSystem<2>::set_gravity(const Point<2>&);
template void SolidSystem<3>::set_gravity(const Point<3>&);
template bool SolidSystem<2>::begin_step(double, double);
template Reduction SolidSystem<2>::constraints(double, double, const RCP<const Vector>&) const;
template void SolidSystem<2>::move(const Vector&, double, double);
template void SolidSystem<3>::find_reduction();
template bool SolidSystem<3>::begin_step(double, double);
template Reduction SolidSystem<3>::constraints(double, double, const RCP<const Vector>&) const;
template void SolidSystem<3>::move(const Vector&, double, double);

}  // namespace lockstep
