#include "rigid/rigid_bodies.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "rigid/body_load.hpp"
#include "rigid/rigid_parameters.hpp"

namespace lockstep {

namespace {
template <int dim>
const SurfaceMesh<dim>& shown_surface(const RigidBody<dim>& body) {
  static const SurfaceMesh<dim> none;
  return body.seen_by_fluid ? body.surface : none;
}
}  // namespace

template <int dim>
RigidBodies<dim>::RigidBodies(std::vector<RigidBody<dim>> bodies, const Point<dim>& gravity,
                              const Communicator& comm, double start_time)
    : comm_(comm), gravity_(gravity), bodies_(std::move(bodies)), time_(start_time) {
  for (RigidBody<dim>& body : bodies_) {
    if (!body.dynamic())
      follow_script(body, start_time);
    body.last_move.origin = body.pose.position;
  }
  describe();
  const long long n = static_cast<long long>(dynamic_.size());
  own_begin_ = static_cast<int>(n * comm->getRank() / comm->getSize());
  own_end_ = static_cast<int>(n * (comm->getRank() + 1) / comm->getSize());
  map_ = make_map((own_end_ - own_begin_) * n_rigid_dofs<dim>, comm);
  update_surface();
  mass_ = assemble_mass();
}

template <int dim>
void RigidBodies<dim>::describe() {
  int n_dofs = 0;
  for (int b = 0; b < static_cast<int>(bodies_.size()); ++b) {
    const RigidBody<dim>& body = bodies_[b];
    SolidDescription solid;
    solid.name = body.name;
    solid.closed = body.closed && body.seen_by_fluid;
    solid.prescribed = !body.dynamic();
    solid.rigid = true;
    solid.density = body.density;
    solid.restitution = body.restitution;
    solid.friction = body.friction;
    solid.index_in_model = b;
    solid.simplex_begin = static_cast<int>(surface_.simplices.size());
    solid.vertex_begin = static_cast<int>(surface_.vertices.size());
    for (auto simplex : shown_surface(body).simplices) {
      for (int& vertex : simplex)
        vertex += solid.vertex_begin;
      surface_.simplices.push_back(simplex);
      body_of_simplex_.push_back(b);
    }
    const auto& vertices = shown_surface(body).vertices;
    surface_.vertices.insert(surface_.vertices.end(), vertices.begin(), vertices.end());
    solid.simplex_end = static_cast<int>(surface_.simplices.size());
    solid.vertex_end = static_cast<int>(surface_.vertices.size());
    solids_.push_back(solid);
    first_dof_.push_back(body.dynamic() ? n_dofs : -1);
    if (body.dynamic()) {
      dynamic_.push_back(b);
      n_dofs += n_rigid_dofs<dim>;
    }
  }
}

template <int dim>
void RigidBodies<dim>::update_surface() {
  auto vertex = surface_.vertices.begin();
  for (const RigidBody<dim>& body : bodies_) {
    const Eigen::Matrix<double, dim, dim> rotation = body.pose.orientation.toRotationMatrix();
    for (const Point<dim>& x : shown_surface(body).vertices)
      *vertex++ = body.pose.position + rotation * x;
  }
}

template <int dim>
RCP<const LinearOperator> RigidBodies<dim>::assemble_mass() const {
  constexpr int n = n_rigid_dofs<dim>;
  const RCP<CrsMatrix> matrix = rcp(new CrsMatrix(map_, map_, n));
  for_each_own([&](const RigidBody<dim>& body, int first_row) {
    const RigidMatrix<dim> mass = mass_matrix(body, body.pose.orientation);
    int columns[n];
    for (int k = 0; k < n; ++k)
      columns[k] = first_row + k;
    for (int k = 0; k < n; ++k) {
      matrix->insertLocalValues(first_row + k, Teuchos::arrayView(columns, n),
                                Teuchos::arrayView(mass.col(k).data(), n));  // symmetric
    }
  });
  matrix->fillComplete(map_, map_);
  return as_operator(matrix);
}

template <int dim>
template <typename Function>
void RigidBodies<dim>::for_each_own(const Function& f) const {
  for (int d = own_begin_; d < own_end_; ++d)
    f(bodies_[dynamic_[d]], (d - own_begin_) * n_rigid_dofs<dim>);
}

template <int dim>
std::vector<RigidVector<dim>> RigidBodies<dim>::gather(const Vector& values) const {
  const auto mine = values.getData();
  std::vector<RigidVector<dim>> result(dynamic_.size());
  std::vector<double> all(result.size() * n_rigid_dofs<dim>, 0);  // zero where others have them
  std::copy(mine.begin(), mine.end(), all.begin() + own_begin_ * n_rigid_dofs<dim>);
  sum_over_ranks(comm_, all);
  for (std::size_t d = 0; d < result.size(); ++d)
    result[d] = Eigen::Map<const RigidVector<dim>>(all.data() + d * n_rigid_dofs<dim>);
  return result;
}

template <int dim>
void RigidBodies<dim>::velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                                    VelocityRow<dim>& row) const {
  row.clear();
  const int b = body_of_simplex_[point.simplex];
  if (first_dof_[b] < 0)
    return;
  for (int k = 0; k < n_rigid_dofs<dim>; ++k)
    row.dofs.push_back(first_dof_[b] + k);
  for (int a = 0; a < dim; ++a)
    row.coefficients.push_back(Point<dim>::Unit(a));
  for (int r = 0; r < n_rotations<dim>; ++r)
    row.coefficients.push_back(
        rotate<dim>(AngularVector<dim>::Unit(r), x - bodies_[b].pose.position));
}

template <int dim>
Point<dim> RigidBodies<dim>::prescribed_velocity(const SurfacePoint<dim>& point,
                                                 const Point<dim>& x) const {
  const RigidBody<dim>& body = body_of(point);
  return body.dynamic() ? Point<dim>(Point<dim>::Zero()) : body.velocity_at(x);
}

template <int dim>
Point<dim> RigidBodies<dim>::effective_velocity(const SurfacePoint<dim>& point,
                                                const Point<dim>& x) const {
  return body_of(point).last_move.velocity(x);
}

/// In S2 at the middle of the step, which makes velocities second order; in S1 at the time whose
/// force carries the body as far as one that grows linearly, two thirds of the half step dt.
template <int dim>
Load<dim> RigidBodies<dim>::load_on(const RigidBody<dim>& body, double time, double dt) const {
  Load<dim> load;
  if (body.load && has_moved_) {
    const Point<dim> before = body.pose_before.position + body.arm(body.pose_before.orientation);
    load = body.load(time + dt / 2, (before + body.center()) / 2);
  } else if (body.load) {
    load = body.load(time + 2 * dt / 3, body.center());
  }
  load.force += body.mass * gravity_;
  return load;
}

template <int dim>
RigidVector<dim> RigidBodies<dim>::load_impulse(const RigidBody<dim>& body, double time,
                                                double dt) const {
  const Load<dim> load = load_on(body, time, dt);
  const Point<dim> impulse = dt * load.force;
  RigidVector<dim> generalized;
  generalized << impulse, cross<dim>(body.arm(), impulse) + dt * load.torque;
  return generalized;
}

template <int dim>
bool RigidBodies<dim>::set_load(int solid, const Point<dim>& force,
                                const AngularVector<dim>& torque) {
  check_input(bodies_[solid].dynamic(), "\"{}\" is prescribed; no force moves it.",
              solids_[solid].name);
  bodies_[solid].load = constant_load<dim>({force, torque});
  return true;
}

template <int dim>
void RigidBodies<dim>::explicit_momentum(double time, double dt, Vector& momentum) const {
  const auto values = momentum.getDataNonConst();
  for_each_own([&](const RigidBody<dim>& body, int first_row) {
    const RigidVector<dim> total = body.momentum + load_impulse(body, time, dt);
    std::copy(total.data(), total.data() + total.size(), values.begin() + first_row);
  });
}

template <int dim>
void RigidBodies<dim>::add_midpoint_correction(double dt, Vector& momentum) const {
  const auto values = momentum.getDataNonConst();
  for_each_own([&](const RigidBody<dim>& body, int first_row) {
    // A body in the fluid does not respond to its load alone: a light one would turn without bound.
    RigidVector<dim> start = body.momentum;
    if (!body.seen_by_fluid)
      start += load_impulse(body, time_, dt);
    const RigidVector<dim> correction = midpoint_correction<dim>(body, start, dt);
    for (int k = 0; k < n_rigid_dofs<dim>; ++k)
      values[first_row + k] += correction[k];
  });
}

template <int dim>
Momentum<dim> RigidBodies<dim>::external_impulse(double time, double dt) const {
  Momentum<dim> total;
  for (const int b : dynamic_) {
    const RigidBody<dim>& body = bodies_[b];
    const Load<dim> load = load_on(body, time, dt);
    total.add(body.center(), dt * load.force);
    total.angular += dt * load.torque;
  }
  return total;
}

template <int dim>
std::vector<GlobalIndex> RigidBodies<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  for_each_own([&](const RigidBody<dim>& body, int first_row) {
    for (int k = 0; k < n_rigid_dofs<dim>; ++k) {
      if (body.locked[k])
        dofs.push_back(map_->getGlobalElement(first_row + k));
    }
  });
  return dofs;
}

template <int dim>
std::vector<Momentum<dim>> RigidBodies<dim>::momentum_of_each(
    const Vector& generalized_momentum) const {
  const auto values = gather(generalized_momentum);
  std::vector<Momentum<dim>> all(bodies_.size());
  for (std::size_t d = 0; d < dynamic_.size(); ++d) {
    const int b = dynamic_[d];
    all[b].add(bodies_[b].pose.position, values[d].template head<dim>());
    all[b].angular += values[d].template tail<n_rotations<dim>>();
  }
  return all;
}

template <int dim>
RCP<const Vector> RigidBodies<dim>::velocity() const {
  const auto result = make_vector(map_);
  {
    const auto values = result->getDataNonConst();
    for_each_own([&](const RigidBody<dim>& body, int first_row) {
      std::copy(body.velocity.data(), body.velocity.data() + body.velocity.size(),
                values.begin() + first_row);
    });
  }
  return result;
}

template <int dim>
void RigidBodies<dim>::set_velocity(const Vector& velocity) {
  const auto values = gather(velocity);
  for (std::size_t d = 0; d < dynamic_.size(); ++d)
    lockstep::set_velocity(bodies_[dynamic_[d]], values[d]);
}

template <int dim>
void RigidBodies<dim>::move(const Vector& velocity, double time, double dt) {
  const auto values = gather(velocity);
  std::size_t d = 0;
  for (RigidBody<dim>& body : bodies_) {
    const RigidVector<dim> own = body.dynamic() ? values[d++] : RigidVector<dim>::Zero();
    lockstep::move(body, own, time, dt);
  }
  time_ = time + dt;
  has_moved_ = true;
  update_surface();
  mass_ = assemble_mass();
}

template <int dim>
Point<dim> RigidBodies<dim>::carried(int solid, const Point<dim>& x) const {
  const RigidBody<dim>& body = bodies_[solid];
  const RigidPose<dim>& before = body.pose_before;
  return body.pose.position +
         body.pose.orientation * (before.orientation.inverse() * (x - before.position));
}

template <int dim>
std::vector<SolidState<dim>> RigidBodies<dim>::states() const {
  std::vector<SolidState<dim>> all;
  for (const RigidBody<dim>& body : bodies_) {
    SolidState<dim> state;
    state.name = body.name;
    state.center_of_mass = body.center();
    state.velocity = body.velocity_of_center();
    state.angular_velocity = body.angular_velocity();
    state.mass = body.mass;
    state.volume = body.volume;
    state.kinetic_energy = body.dynamic() ? kinetic_energy(body) : 0;
    all.push_back(state);
  }
  return all;
}

template <int dim>
RigidFrame<dim> RigidBodies<dim>::rigid_frame(int solid) const {
  const RigidBody<dim>& body = bodies_[solid];
  RigidFrame<dim> frame{body.pose.position, body.pose.orientation, body.velocity};
  if (body.dynamic())
    frame.mass = mass_matrix(body, body.pose.orientation);
  return frame;
}

template <int dim>
RigidFrame<dim> RigidBodies<dim>::prescribed_frame(int solid, double time) const {
  const RigidPose<dim>& start = bodies_[solid].initial_pose;
  const ScriptedMotion<dim> motion = bodies_[solid].script(time);
  RigidFrame<dim> frame{start.position + motion.displacement,
                        turned<dim>(motion.turn, start.orientation)};
  frame.velocity << motion.velocity, motion.angular_velocity;
  return frame;
}

/// Both are ties to space of their own.
template <int dim>
std::string RigidBodies<dim>::unjointable(int solid) const {
  const RigidBody<dim>& body = bodies_[solid];
  const auto& locked = body.locked;
  if (std::any_of(locked.begin(), locked.end(), [](bool lock) { return lock; }))
    return "Locked";
  return body.dynamic() && !body.center_of_mass.isZero(0) ? "Pivot" : "";
}

template <int dim>
std::unique_ptr<RigidBodies<dim>> make_rigid_bodies(
    const std::vector<std::pair<std::string, ParameterList>>& bodies, double grid_spacing,
    const Point<dim>& gravity, const Communicator& comm, double start_time) {
  if (bodies.empty())
    return nullptr;
  std::vector<RigidBody<dim>> made;
  for (const auto& [name, list] : bodies)
    made.push_back(read_rigid_body<dim>(name, list, grid_spacing));
  return std::make_unique<RigidBodies<dim>>(std::move(made), gravity, comm, start_time);
}

template class RigidBodies<2>;
template class RigidBodies<3>;
template std::unique_ptr<RigidBodies<2>> make_rigid_bodies<2>(
    const std::vector<std::pair<std::string, ParameterList>>&, double, const Point<2>&,
    const Communicator&, double);
template std::unique_ptr<RigidBodies<3>> make_rigid_bodies<3>(
    const std::vector<std::pair<std::string, ParameterList>>&, double, const Point<3>&,
    const Communicator&, double);

}  // namespace lockstep
