#include "deformable/deformable_solids.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "deformable/body_states.hpp"
#include "deformable/element_frames.hpp"

namespace lockstep {

namespace {

/// Edges of all bodies in original numbers.
template <int dim>
std::vector<LimitedEdge> all_limited_edges(const std::vector<DeformableBody<dim>>& bodies,
                                           const BodyNodes<dim>& nodes) {
  std::vector<LimitedEdge> edges;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (LimitedEdge edge : bodies[b].limited_edges) {
      for (int& corner : edge.corners)
        corner += nodes.bodies[b].node_begin;
      edges.push_back(edge);
    }
  }
  return edges;
}

/// Returns one over the mass along each axis; zero for nodes that are held or carried.
template <int dim>
std::vector<Point<dim>> mobility(const BodyNodes<dim>& nodes) {
  std::vector<Point<dim>> inverse(nodes.n_owned());
  for (int i = 0; i < nodes.n_owned(); ++i)
    inverse[i].setConstant(nodes.mass[i] > 0 ? 1 / nodes.mass[i] : 0);
  nodes.hold(inverse);
  return inverse;
}

}  // namespace

template <int dim>
DeformableSolids<dim>::DeformableSolids(const std::string& type,
                                        const std::vector<DeformableBody<dim>>& bodies,
                                        const Point<dim>& gravity, const Communicator& comm,
                                        double start_time)
    : type_(type),
      nodes_(bodies, gravity, comm, start_time),
      surface_(bodies, nodes_),
      turn_(nodes_, states_),
      forces_(bodies, nodes_),
      implicit_(nodes_, turn_, forces_),
      explicit_(nodes_, forces_),
      sweep_(nodes_, surface_, states_, turn_),
      strain_limit_(all_limited_edges(bodies, nodes_), nodes_.space, comm->getRank()) {
  nodes_.space.forget_numbers();
  surface_.place(surface_.velocity());
  update();
  implicit_.bound_frequencies();
}

template <int dim>
std::vector<int> DeformableSolids<dim>::solid_of_row() const {
  std::vector<int> solids;
  for (int i = 0; i < nodes_.n_owned(); ++i)
    solids.insert(solids.end(), dim, nodes_.body_of[i]);
  return solids;
}

template <int dim>
RigidMotions DeformableSolids<dim>::near_null_space() const {
  RigidMotions space;
  space.n_bodies = nodes_.n_bodies();
  const auto motions = rcp(new MultiVector(dof_map(), dim + n_rotations<dim>));
  for (int j = 0; j < dim + n_rotations<dim>; ++j) {
    const auto values = motions->getDataNonConst(j);
    for (int i = 0; i < nodes_.n_owned(); ++i) {
      Point<dim> velocity = Point<dim>::Unit(j % dim);
      if (j >= dim) {
        const Point<dim> arm = nodes_.x[i] - states_[nodes_.body_of[i]].center_of_mass;
        velocity = rotate<dim>(AngularVector<dim>::Unit(j - dim), arm);
      }
      Eigen::Map<Point<dim>>(values.getRawPtr() + dim * i) = velocity;
    }
  }
  space.motions = motions;
  space.body_of_row = solid_of_row();
  return space;
}

/// The unknown of S1 is the velocity at the begin of the arc on which a body turns: its inner
/// forces give the mean one, V + drift.
template <int dim>
void DeformableSolids<dim>::explicit_momentum(double, double dt, Vector& momentum) const {
  RCP<const Vector> start = nodes_.velocity;
  if (dt > 0 && turn_.any() && !implicit_.has_moved()) {
    Nodes at_begin = nodes_.space.owned(*start);
    for (int i = 0; i < nodes_.n_owned(); ++i)
      at_begin[i] -= turn_.drift(i);
    start = nodes_.space.vector(at_begin);
  }
  apply(*nodes_.mass_matrix, *start, momentum);
  if (dt == 0)
    return;
  const bool any_explicit = std::any_of(nodes_.bodies.begin(), nodes_.bodies.end(),
                                        [](const SoftBody& body) { return body.is_explicit(); });
  const Nodes velocity = any_explicit ? nodes_.space.with_ghosts(*nodes_.velocity) : Nodes();
  const Nodes& elastic = explicit_.averaged_forces();
  const auto values = momentum.getDataNonConst();
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    Point<dim> force = elastic[i] + nodes_.load[i] + nodes_.mass[i] * nodes_.gravity;
    if (nodes_.body(i).is_explicit())
      force -= forces_.damping.row_times(i, velocity);
    Point<dim> impulse = dt * force;
    // Before the positions move, S1 may be solved again, and is limited anew.
    if (implicit_.has_moved() && !limiting_impulse_.empty())
      impulse += limiting_impulse_[i];
    for (int a = 0; a < dim; ++a)
      values[dim * i + a] += impulse[a];
  }
}

template <int dim>
void DeformableSolids<dim>::begin_step(double time, double dt) {
  step_ = dt;
  explicit_.begin_step(dt, nodes_.held.begin_step(time));
  const std::vector<char> is_free = nodes_.free_bodies();
  turn_.begin(dt, is_free);
  implicit_.soften(dt, is_free);
  implicit_.look_ahead();
}

template <int dim>
std::vector<GlobalIndex> DeformableSolids<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  for (const int dof : nodes_.held.dofs())
    dofs.push_back(dof_map()->getGlobalElement(dof));
  return dofs;
}

template <int dim>
std::vector<NodeAttachment<dim>> DeformableSolids<dim>::attachments() const {
  std::vector<NodeAttachment<dim>> all;
  for (const auto& [node, solid] : nodes_.attached) {
    NodeAttachment<dim> attachment;
    for (int a = 0; a < dim; ++a)
      attachment.dofs[a] = dof_map()->getGlobalElement(dim * node + a);
    attachment.position = nodes_.x[node];
    attachment.solid = solid;
    all.push_back(attachment);
  }
  return all;
}

template <int dim>
void DeformableSolids<dim>::set_velocity(const Vector& velocity) {
  nodes_.velocity = rcp(new Vector(velocity, Teuchos::Copy));
  limiting_impulse_.clear();
  // The first of two kicks ends nothing, nor does what moves bodies outside of steps.
  const bool ends = implicit_.has_moved() && step_ > 0 && forces_.end_step(nodes_.x, step_);
  turn_.end();
  implicit_.end_step(ends);
  if (ends) {
    step_ = 0;
    explicit_.update_largest_stable_step();
  }
  states_ = body_states(nodes_, surface_, forces_.energy);
}

/// The impulses enter the momentum of S2 as well: they sum to zero on every edge.
template <int dim>
void DeformableSolids<dim>::limit_motion(double dt, Vector& velocity) {
  if (strain_limit_.empty())
    return;
  const NodeSpace<dim>& space = nodes_.space;
  const Nodes inverse = space.with_ghosts(*space.vector(mobility(nodes_)));
  Nodes limited = space.with_ghosts(velocity);
  limiting_impulse_.assign(space.n_local(), Point<dim>::Zero());
  stretch_beyond_limit_ =
      strain_limit_.apply(nodes_.x, inverse, dt, space, limited, limiting_impulse_);
  velocity.update(1, *space.vector(limited), 0);
}

template <int dim>
void DeformableSolids<dim>::move(const Vector& velocity, double, double dt) {
  if (dt != turn_.dt())
    turn_.end();  // no step, but a motion by the way
  const Nodes change = nodes_.space.with_ghosts(velocity);
  Nodes before = nodes_.x;
  for (int i = 0; i < nodes_.space.n_local(); ++i)
    nodes_.x[i] += dt * (change[i] + turn_.drift(i));
  surface_.move(change);
  turn_.find_rotation(change);
  implicit_.moved(std::move(before), dt);
  update();
}

template <int dim>
RCP<const Vector> DeformableSolids<dim>::drift() const {
  if (!turn_.any())
    return Teuchos::null;
  Nodes drift;
  for (int i = 0; i < nodes_.n_owned(); ++i)
    drift.push_back(implicit_.has_moved() ? turn_.next_drift(i) : turn_.drift(i));
  return nodes_.space.vector(drift);
}

template <int dim>
void DeformableSolids<dim>::update() {
  implicit_.update();
  explicit_.update_largest_stable_step();
  find_load();
  states_ = body_states(nodes_, surface_, forces_.energy);
}

template <int dim>
void DeformableSolids<dim>::set_gravity(const Point<dim>& gravity) {
  if (gravity == nodes_.gravity)
    return;
  nodes_.gravity = gravity;
  find_load();
}

template <int dim>
void DeformableSolids<dim>::find_load() {
  Momentum<dim> load;
  for (int i = 0; i < nodes_.n_owned(); ++i)
    load.add(nodes_.x[i], nodes_.mass[i] * nodes_.gravity + nodes_.load[i]);
  load_ = sum_over_ranks<dim>(load, nodes_.comm);
}

template <int dim>
std::vector<Momentum<dim>> DeformableSolids<dim>::momentum_of_each(
    const Vector& generalized_momentum) const {
  constexpr int n = dim + n_rotations<dim>;
  std::vector<double> sums(nodes_.bodies.size() * n, 0);
  const Nodes impulse = nodes_.space.owned(generalized_momentum);
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    double* sum = &sums[nodes_.body_of[i] * n];
    Eigen::Map<Point<dim>>(sum, dim) += impulse[i];
    Eigen::Map<AngularVector<dim>>(sum + dim, n_rotations<dim>) +=
        cross<dim>(nodes_.x[i], impulse[i]);
  }
  sum_all(nodes_.comm, sums.data(), static_cast<int>(sums.size()));
  std::vector<Momentum<dim>> all(nodes_.bodies.size());
  for (std::size_t b = 0; b < all.size(); ++b) {
    all[b].linear = Eigen::Map<Point<dim>>(&sums[b * n], dim);
    all[b].angular = Eigen::Map<AngularVector<dim>>(&sums[b * n + dim], n_rotations<dim>);
  }
  return all;
}

template <int dim>
AngularVector<dim> DeformableSolids<dim>::inner_angular_impulse(double dt) const {
  const Nodes& force = explicit_.averaged_forces();
  Momentum<dim> sum;
  for (int i = 0; i < nodes_.n_owned(); ++i)
    sum.add(nodes_.x[i], dt * force[i] + (limiting_impulse_.empty() ? Point<dim>(Point<dim>::Zero())
                                                                    : limiting_impulse_[i]));
  return sum_over_ranks<dim>(sum, nodes_.comm).angular;
}

/// Works of the forces in `explicit_momentum` and D; the work of the stretch limit counts as
/// elastic.
template <int dim>
std::optional<SolidWork> DeformableSolids<dim>::solid_work(double, double dt,
                                                           const Vector& velocity,
                                                           const Vector& mean) const {
  const NodeSpace<dim>& space = nodes_.space;
  const Nodes found = space.with_ghosts(velocity), before = space.with_ghosts(*nodes_.velocity),
              rate = space.owned(mean);
  const Nodes& elastic = explicit_.averaged_forces();
  double sums[3] = {0, 0, 0};
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    const SoftBody& body = nodes_.body(i);
    Point<dim> impulse = dt * elastic[i];
    if (const double share = implicit_.share(body); share > 0)
      impulse -= share * dt * dt * forces_.stiffness.row_times(i, found);
    if (!limiting_impulse_.empty())
      impulse += limiting_impulse_[i];
    sums[0] += rate[i].dot(impulse);
    sums[1] -= dt * rate[i].dot(forces_.damping.row_times(i, body.is_explicit() ? before : found));
    sums[2] += dt * rate[i].dot(nodes_.load[i] + nodes_.mass[i] * nodes_.gravity);
  }
  sum_all(nodes_.comm, sums, 3);
  SolidWork work;
  work.elastic = sums[0];
  work.damping = sums[1];
  work.loads = sums[2];
  return work;
}

template <int dim>
void DeformableSolids<dim>::add_frames(std::vector<SurfaceFrame>& frames) const {
  add_element_frames(forces_, frames);
}

template class DeformableSolids<2>;
template class DeformableSolids<3>;

}  // namespace lockstep
