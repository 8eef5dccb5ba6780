#include "deformable/deformable_solids.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
void DeformableSolids<dim>::velocity_row(const SurfacePoint<dim>& point, const Point<dim>&,
                                         VelocityRow<dim>& row) const {
  row.clear();
  for (int k = 0; k < dim; ++k) {
    if (point.barycentric[k] == 0)
      continue;
    const GlobalIndex node = surface_node_[surface_.simplices[point.simplex][k]];
    for (int a = 0; a < dim; ++a) {
      row.dofs.push_back(dim * node + a);
      row.coefficients.push_back(point.barycentric[k] * Point<dim>::Unit(a));
    }
  }
}

template <int dim>
Point<dim> DeformableSolids<dim>::effective_velocity(const SurfacePoint<dim>& point,
                                                     const Point<dim>&) const {
  Point<dim> sum = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    sum += point.barycentric[k] * surface_velocity_[surface_.simplices[point.simplex][k]];
  return sum;
}

template <int dim>
double DeformableSolids<dim>::elastic_share(const Body& body) const {
  const bool second_order = body.integration == TimeIntegration::second_order;
  if (!second_order && body.integration != TimeIntegration::fully_implicit)
    return 0;
  if (!moved_)
    return 2;
  return second_order ? 0.5 : 1;
}

template <int dim>
RCP<const LinearOperator> DeformableSolids<dim>::implicit_force(double dt) const {
  if (!implicit_force_.is_null() && implicit_force_dt_ == dt)
    return implicit_force_;
  NodeMatrix<dim> sum = stiffness_;
  sum.set_zero();
  bool any = false;
  for (const Body& body : bodies_)
    any = any || body.integration != TimeIntegration::explicit_forces;
  if (!any)
    return Teuchos::null;
  for (int i = 0; i < space_.n_owned(); ++i) {
    const TimeIntegration integration = bodies_[body_of_node_[i]].integration;
    if (integration == TimeIntegration::explicit_forces)
      continue;
    sum.add_row(i, -1, damping_);
    if (const double share = elastic_share(bodies_[body_of_node_[i]]); share > 0)
      sum.add_row(i, -share * dt, stiffness_);
  }
  implicit_force_ = as_operator(space_.matrix(sum));
  implicit_force_dt_ = dt;
  return implicit_force_;
}

template <int dim>
void DeformableSolids<dim>::explicit_momentum(double, double dt, Vector& momentum) const {
  apply(*mass_, *velocity_, momentum);
  if (dt == 0)
    return;
  const bool any_explicit = std::any_of(bodies_.begin(), bodies_.end(), [](const Body& body) {
    return body.integration == TimeIntegration::explicit_forces;
  });
  const Nodes velocity = any_explicit ? space_.with_ghosts(*velocity_) : Nodes();
  const Nodes& elastic = averaged_forces();
  const auto values = momentum.getDataNonConst();
  for (int i = 0; i < space_.n_owned(); ++i) {
    Point<dim> force = elastic[i] + node_force_[i] + node_mass_[i] * gravity_;
    if (bodies_[body_of_node_[i]].integration == TimeIntegration::explicit_forces)
      force -= damping_.row_times(i, velocity);
    Point<dim> impulse = dt * force;
    // Before the positions move, S1 may be solved again, and is limited anew.
    if (moved_ && !limiting_impulse_.empty())
      impulse += limiting_impulse_[i];
    for (int a = 0; a < dim; ++a)
      values[dim * i + a] += impulse[a];
  }
}

template <int dim>
Momentum<dim> DeformableSolids<dim>::external_impulse(double, double dt) const {
  return {dt * load_.linear, dt * load_.angular};
}

template <int dim>
void DeformableSolids<dim>::begin_step(double time, double dt) {
  const bool holds_others = held_.begin_step(time);
  if (holds_others ||
      dt != step_)  // else S2 of the last step has averaged them where S1 needs them
    averaged_force_.reset();
  step_ = dt;
  soften(dt);
}

template <int dim>
std::vector<GlobalIndex> DeformableSolids<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  for (const int dof : held_.dofs())
    dofs.push_back(space_.dof_map()->getGlobalElement(dof));
  return dofs;
}

template <int dim>
std::vector<NodeAttachment<dim>> DeformableSolids<dim>::attachments() const {
  std::vector<NodeAttachment<dim>> all;
  for (const auto& [node, solid] : attached_) {
    NodeAttachment<dim> attachment;
    for (int a = 0; a < dim; ++a)
      attachment.dofs[a] = space_.dof_map()->getGlobalElement(dim * node + a);
    attachment.position = x_[node];
    attachment.solid = solid;
    all.push_back(attachment);
  }
  return all;
}

template <int dim>
std::vector<Momentum<dim>> DeformableSolids<dim>::momentum_of_each(
    const Vector& generalized_momentum) const {
  std::vector<Momentum<dim>> all(bodies_.size());
  const Nodes impulse = space_.owned(generalized_momentum);
  for (int i = 0; i < space_.n_owned(); ++i)
    all[body_of_node_[i]].add(x_[i], impulse[i]);
  sum_over_ranks(comm_, all);
  return all;
}

template <int dim>
void DeformableSolids<dim>::set_velocity(const Vector& velocity) {
  velocity_ = rcp(new Vector(velocity, Teuchos::Copy));
  limiting_impulse_.clear();
  before_.reset();
  moved_ = false;
  linearisation_ = Teuchos::null;
  implicit_force_ = Teuchos::null;  // S1 needs another one
  if (linearised_)
    update_forces();
  update_states();
}

/// With x* = x + dt V the force of the next V' is f(x*) - dt K(x*) (V' - V): explicit is f + dt K
/// V. Of second order, in S2: x and dt are those at the start and half of the step.
template <int dim>
bool DeformableSolids<dim>::linearise(double dt, const Vector& velocity) {
  const auto share = [this](int node) { return elastic_share(bodies_[body_of_node_[node]]); };
  if (!has_implicit_forces())
    return false;
  const Nodes v = space_.with_ghosts(velocity);
  Nodes x = before_ ? *before_ : x_;
  for (int i = 0; i < space_.n_local(); ++i)
    x[i] += share(i) * dt * v[i];
  assemble_forces(x);
  for (int i = 0; i < space_.n_owned(); ++i) {
    if (share(i) > 0)
      elastic_force_[i] += share(i) * dt * stiffness_.row_times(i, v);
  }
  linearised_ = true;
  linearisation_ = rcp(new Vector(velocity, Teuchos::Copy));
  return true;
}

template <int dim>
void DeformableSolids<dim>::move(const Vector& velocity, double, double dt) {
  const Nodes change = space_.with_ghosts(velocity);
  const auto is_second_order = [](const Body& body) {
    return body.integration == TimeIntegration::second_order;
  };
  if (std::any_of(bodies_.begin(), bodies_.end(), is_second_order))
    before_ = x_;
  for (int i = 0; i < space_.n_local(); ++i) {
    x_[i] += dt * change[i];
    if (before_ && !is_second_order(bodies_[body_of_node_[i]]))
      (*before_)[i] = x_[i];
  }
  std::vector<Nodes> at_surface = surface_values({&x_, &change});
  surface_.vertices = std::move(at_surface[0]);
  surface_velocity_ = std::move(at_surface[1]);
  moved_ = true;
  linearisation_ = Teuchos::null;
  if (before_) {
    Nodes halfway(space_.n_owned(), Point<dim>::Zero());
    for (int i = 0; i < space_.n_owned(); ++i) {
      if (is_second_order(bodies_[body_of_node_[i]]))
        halfway[i] = change[i];
    }
    linearisation_ = space_.vector(halfway);
  }
  update_within_surface();
}

/// Updates the forces at the present positions; for second-order bodies that have moved, those of
/// S2: halfway, for dt V / 2 = x - x(halfway) of the motion.
template <int dim>
void DeformableSolids<dim>::update_forces() {
  linearised_ = before_.has_value();
  if (!linearised_) {
    assemble_forces(x_);
    return;
  }
  Nodes halfway = x_, rest = x_;
  for (int i = 0; i < space_.n_local(); ++i) {
    halfway[i] = 0.5 * ((*before_)[i] + x_[i]);
    rest[i] -= halfway[i];
  }
  assemble_forces(halfway);
  for (int i = 0; i < space_.n_owned(); ++i) {
    if (bodies_[body_of_node_[i]].integration == TimeIntegration::second_order)
      elastic_force_[i] += stiffness_.row_times(i, rest);
  }
}

template <int dim>
std::vector<std::vector<Point<dim>>> DeformableSolids<dim>::surface_values(
    std::initializer_list<const Nodes*> of_nodes) const {
  std::vector<double> mine;
  for (const int node : own_surface_vertices_)
    for (const Nodes* values : of_nodes)
      mine.insert(mine.end(), (*values)[node].data(), (*values)[node].data() + dim);
  const std::vector<double> gathered = gather_all(comm_, mine);
  std::vector<Nodes> all(of_nodes.size(), Nodes(surface_node_.size()));
  const double* next = gathered.data();
  for (std::size_t i = 0; i < surface_node_.size(); ++i)
    for (Nodes& values : all) {
      values[gathered_surface_vertices_[i]] = Eigen::Map<const Point<dim>>(next);
      next += dim;
    }
  return all;
}

template <int dim>
void DeformableSolids<dim>::update_geometry() {
  surface_.vertices = surface_values({&x_})[0];
  update_within_surface();
}

template <int dim>
void DeformableSolids<dim>::update_within_surface() {
  update_forces();
  update_largest_stable_step();
  update_states();
}

template <int dim>
void DeformableSolids<dim>::assemble_forces(const Nodes& x) {
  Nodes force(space_.n_local(), Point<dim>::Zero());
  implicit_force_ = Teuchos::null;
  averaged_force_.reset();
  stiffness_.set_zero();
  damping_.set_zero();
  n_clamped_ = 0;
  std::vector<double> energies;
  for (const Body& body : bodies_) {
    energies.push_back(0);
    for (const auto& group : body.elements) {
      energies.back() += group->add_elastic_forces(x, space_.n_owned(), force);
      n_clamped_ += group->add_stiffness(x, stiffness_);
      group->add_damping(x, damping_);
    }
  }
  force.resize(space_.n_owned());
  elastic_force_ = std::move(force);
  for (int i = 0; i < space_.n_owned(); ++i) {
    const double softening = bodies_[body_of_node_[i]].softening;
    if (softening == 1)
      continue;
    elastic_force_[i] *= softening;
    stiffness_.scale_row(i, softening);
  }
  sum_over_ranks(comm_, energies, n_clamped_);
  Momentum<dim> load;
  for (int i = 0; i < space_.n_owned(); ++i) {
    load.add(x_[i], node_mass_[i] * gravity_ + node_force_[i]);
  }
  load_ = sum_over_ranks<dim>(load, comm_);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    bodies_[b].elastic_energy = bodies_[b].softening * energies[b];
}

template <int dim>
void DeformableSolids<dim>::update_states() {
  constexpr int n_turns = n_rotations<dim>;
  using Inertia = Eigen::Matrix<double, n_turns, n_turns>;
  const int n_bodies = static_cast<int>(bodies_.size());
  const auto q = make_vector(space_.dof_map());
  apply(*mass_, *velocity_, *q);
  const Nodes momentum = space_.owned(*q), velocity = space_.owned(*velocity_);
  // A massless body has the means of its surface.
  const auto is_massless = [this](int i) { return bodies_[body_of_node_[i]].mass == 0; };
  const auto weight = [&](int i) { return is_massless(i) ? node_share_[i] : node_mass_[i]; };
  const auto weighted = [&](int i) -> Point<dim> {
    return is_massless(i) ? Point<dim>(node_share_[i] * velocity[i]) : momentum[i];
  };
  std::vector<Point<dim>> places(n_bodies, Point<dim>::Zero()), velocities = places;
  std::vector<double> energies(n_bodies, 0);
  for (int i = 0; i < space_.n_owned(); ++i) {
    const int b = body_of_node_[i];
    places[b] += weight(i) * x_[i];
    velocities[b] += weighted(i);
    energies[b] += 0.5 * momentum[i].dot(velocity[i]);
  }
  sum_over_ranks(comm_, places, velocities, energies);
  states_.assign(n_bodies, {});
  for (int b = 0; b < n_bodies; ++b) {
    SolidState<dim>& state = states_[b];
    state.name = bodies_[b].name;
    state.mass = bodies_[b].mass;
    const double total = state.mass > 0 ? state.mass : 1;
    state.center_of_mass = places[b] / total;
    state.velocity = velocities[b] / total;
    state.kinetic_energy = energies[b];
    state.elastic_energy = bodies_[b].elastic_energy;
    for (int s = solids_[b].simplex_begin; bodies_[b].closed && s < solids_[b].simplex_end; ++s) {
      std::array<Point<dim>, dim> corners;
      for (int k = 0; k < dim; ++k)
        corners[k] = surface_.vertices[surface_.simplices[s][k]];
      state.volume += area_vector<dim>(corners).dot(corners[0] - state.center_of_mass) / dim;
    }
  }
  std::vector<AngularVector<dim>> spins(n_bodies, AngularVector<dim>::Zero());
  std::vector<Inertia> inertias(n_bodies, Inertia::Zero());
  for (int i = 0; i < space_.n_owned(); ++i) {
    const int b = body_of_node_[i];
    const Point<dim> arm = x_[i] - states_[b].center_of_mass;
    spins[b] += cross<dim>(arm, weighted(i));
    Inertia inertia = arm.squaredNorm() * Inertia::Identity();
    if constexpr (dim == 3)
      inertia -= arm * arm.transpose();
    inertias[b] += weight(i) * inertia;
  }
  sum_over_ranks(comm_, spins, inertias);
  for (int b = 0; b < n_bodies; ++b)
    states_[b].angular_velocity = inertias[b].ldlt().solve(spins[b]);
}

template class DeformableSolids<2>;
template class DeformableSolids<3>;

}  // namespace lockstep
