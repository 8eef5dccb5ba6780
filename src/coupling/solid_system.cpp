#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "coupling/solid_system.hpp"

namespace lockstep {

template <int dim>
SolidSystem<dim>::SolidSystem(std::vector<std::unique_ptr<SolidModel<dim>>> models,
                              const Communicator& comm, std::unique_ptr<ConstraintModel> joints)
    : comm_(comm), models_(std::move(models)), joints_(std::move(joints)) {
  int n_simplices = 0, n_vertices = 0;
  std::vector<GlobalIndex> ids;
  for (int m = 0; m < n_models(); ++m) {
    begin_.push_back({n_simplices, n_unknowns_, static_cast<int>(ids.size())});
    int index = 0;
    for (SolidDescription solid : model(m).solids()) {
      solid.model = m;
      solid.index_in_model = index++;
      solid.simplex_begin += n_simplices;
      solid.simplex_end += n_simplices;
      solid.vertex_begin += n_vertices;
      solid.vertex_end += n_vertices;
      solids_.push_back(solid);
    }
    n_simplices += static_cast<int>(model(m).surface().simplices.size());
    n_vertices += static_cast<int>(model(m).surface().vertices.size());
    const RCP<const Map> map = model(m).dof_map();
    for (GlobalIndex id : map->getNodeElementList())
      ids.push_back(n_unknowns_ + id);
    n_unknowns_ += static_cast<GlobalIndex>(map->getGlobalNumElements());
  }
  n_padding_ = ids.empty() ? 1 : 0;
  const GlobalIndex first = n_unknowns_ + exclusive_sum(comm, GlobalIndex(n_padding_));
  for (int i = 0; i < n_padding_; ++i)
    ids.push_back(first + i);
  map_ = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(ids), 0, comm));
  std::string failure;
  attached_ = find_attached_nodes(models_, begin_, solids_, failure);
  throw_on_all(comm_, failure, static_cast<int>(ExitCode::bad_input));
  carried_.assign(n_models(), 0);
  for (const AttachedNode<dim>& node : attached_)
    carried_[node.model] = 1;
  max_over_ranks(comm_, carried_);
  find_reduction();
}

template <int dim>
std::vector<Block> SolidSystem<dim>::blocks() const {
  std::vector<Block> all;
  for (int m = 0; m < n_models(); ++m) {
    const int n = static_cast<int>(model(m).dof_map()->getNodeNumElements());
    all.push_back({model(m).name(), begin_[m].local, begin_[m].local + n});
  }
  return all;
}

template <int dim>
SurfaceMesh<dim> SolidSystem<dim>::surface() const {
  SurfaceMesh<dim> all;
  for (const auto& solid_model : models_) {
    const SurfaceMesh<dim>& mesh = solid_model->surface();
    const int shift = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (auto simplex : mesh.simplices) {
      for (int& vertex : simplex)
        vertex += shift;
      all.simplices.push_back(simplex);
    }
  }
  return all;
}

template <int dim>
void SolidSystem<dim>::go_round(const Box<dim>& domain, const std::array<bool, dim>& periodic,
                                double margin) {
  std::vector<char> carriers(solids_.size(), 0), wanted(solids_.size(), 0);
  for (const AttachedNode<dim>& node : attached_)
    carriers[node.solid] = 1;
  max_over_ranks(comm_, carriers);
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const SolidDescription& solid = solids_[i];
    const bool is_tied = carriers[i] != 0 || (!solid.rigid && carried_[solid.model] != 0);
    wanted[i] = solid.closed && !solid.prescribed && !is_tied ? 1 : 0;
  }
  repeated_ = RepeatedSolids<dim>(domain, periodic, margin, solids_, surface(), std::move(wanted));
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> SolidSystem<dim>::snapshot(
    const SurfaceSnapshot<dim>* before) const {
  SurfaceMesh<dim> mesh = surface();
  if (!repeated_.empty())
    repeated_.show(solids_, before, mesh);
  auto snapshot = std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh), solids_, order_,
                                                               repeated_.images());
  order_ = snapshot->order();
  return snapshot;
}

template <int dim>
std::vector<SolidState<dim>> SolidSystem<dim>::states() const {
  std::vector<SolidState<dim>> all;
  for (const auto& solid_model : models_) {
    for (const SolidState<dim>& state : solid_model->states())
      all.push_back(state);
  }
  return all;
}

template <int dim>
auto SolidSystem<dim>::in_model(SurfacePoint<dim> point, const Point<dim>& x) const -> ModelPoint {
  ModelPoint result;
  result.x = x;
  if (!repeated_.empty()) {
    point = repeated_.own_point(point);
    result.x = own_place(repeated_.solid_of(point.simplex), x);
  }
  const auto next = std::upper_bound(
      begin_.begin(), begin_.end(), point.simplex,
      [](int simplex, const ModelBegin& begin) { return simplex < begin.simplex; });
  result.model = static_cast<int>(next - begin_.begin()) - 1;
  result.point = point;
  result.point.simplex -= begin_[result.model].simplex;
  return result;
}

template <int dim>
void SolidSystem<dim>::velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                                    VelocityRow<dim>& row) const {
  const ModelPoint local = in_model(point, x);
  model(local.model).velocity_row(local.point, local.x, row);
  for (GlobalIndex& id : row.dofs)
    id += begin_[local.model].id;
}

template <int dim>
Point<dim> SolidSystem<dim>::prescribed_velocity(const SurfacePoint<dim>& point,
                                                 const Point<dim>& x) const {
  const ModelPoint local = in_model(point, x);
  return model(local.model).prescribed_velocity(local.point, local.x);
}

template <int dim>
Point<dim> SolidSystem<dim>::effective_velocity(const SurfacePoint<dim>& point,
                                                const Point<dim>& x) const {
  const ModelPoint local = in_model(point, x);
  return model(local.model).effective_velocity(local.point, local.x);
}

template <int dim>
RCP<const Vector> SolidSystem<dim>::part(const Vector& stacked, int m) const {
  return stacked.offsetView(model(m).dof_map(), begin_[m].local)->getVector(0);
}

template <int dim>
RCP<Vector> SolidSystem<dim>::part(Vector& stacked, int m) const {
  return stacked.offsetViewNonConst(model(m).dof_map(), begin_[m].local)->getVectorNonConst(0);
}

template <int dim>
RCP<Vector> SolidSystem<dim>::velocity() const {
  const auto stacked = rcp(new Vector(map_));
  for (int m = 0; m < n_models(); ++m)
    part(*stacked, m)->update(1, *model(m).velocity(), 0);
  reduction_.follow(*stacked);
  return stacked;
}

template <int dim>
void SolidSystem<dim>::set_velocity(const Vector& velocity) {
  for (int m = 0; m < n_models(); ++m)
    model(m).set_velocity(*part(velocity, m));
  ++linearisation_number_;
}

template <int dim>
RCP<Vector> SolidSystem<dim>::explicit_momentum(double time, double dt) const {
  const auto stacked = rcp(new Vector(map_));
  for (int m = 0; m < n_models(); ++m)
    model(m).explicit_momentum(time, dt, *part(*stacked, m));
  return stacked;
}

template <int dim>
void SolidSystem<dim>::add_midpoint_correction(double dt, Vector& momentum) const {
  Vector all(map_);
  for (int m = 0; m < n_models(); ++m) {
    const RCP<Vector> correction = part(all, m);
    model(m).add_midpoint_correction(dt, *correction);
  }
  momentum.update(1, all, 1);
}

template <int dim>
bool SolidSystem<dim>::linearise(double dt, const Vector& velocity) {
  bool any = false;
  for (int m = 0; m < n_models(); ++m) {
    if (auto* forces = nonlinear(m)) {
      forces->linearise(dt, *part(velocity, m));
      any = true;
    }
  }
  ++linearisation_number_;
  return any;
}

template <int dim>
void SolidSystem<dim>::limit_motion(double dt, Vector& velocity) {
  for (int m = 0; m < n_models(); ++m)
    model(m).limit_motion(dt, *part(velocity, m));
}

template <int dim>
std::vector<Momentum<dim>> SolidSystem<dim>::momentum_of_each(
    const Vector& generalized_momentum) const {
  std::vector<Momentum<dim>> all;
  for (int m = 0; m < n_models(); ++m) {
    const auto* audited = model(m).audit();
    if (!audited) {
      all.resize(all.size() + model(m).solids().size());
      continue;
    }
    for (const auto& momentum : audited->momentum_of_each(*part(generalized_momentum, m)))
      all.push_back(momentum);
  }
  return all;
}

template <int dim>
Momentum<dim> SolidSystem<dim>::momentum(const Vector& generalized_momentum) const {
  Momentum<dim> total;
  for (const auto& momentum : momentum_of_each(generalized_momentum))
    total += momentum;
  return total;
}

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
void SolidSystem<dim>::take_kicks() {
  for (const auto& solid_model : models_)
    solid_model->take_kicks();
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

template <int dim>
RCP<const Vector> SolidSystem<dim>::drift() const {
  RCP<Vector> stacked;
  for (int m = 0; m < n_models(); ++m) {
    const RCP<const Vector> of_model = model(m).drift();
    if (of_model.is_null())
      continue;
    if (stacked.is_null())
      stacked = make_vector(map_);
    part(*stacked, m)->update(1, *of_model, 0);
  }
  return stacked;
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

template class SolidSystem<2>;
template class SolidSystem<3>;

}  // namespace lockstep
