#pragma once
#include <Teuchos_DefaultComm.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contact/gauss_seidel_contact.hpp"
#include "geometry/generators.hpp"
#include "rigid/rigid_bodies.hpp"

namespace lockstep::test {

constexpr double h = 0.1;  // the spacing of a grid that is not there [m]
constexpr double g = 9.81;

inline Communicator world_communicator() {
  return Teuchos::DefaultComm<int>::getComm();
}
inline Communicator own_communicator() {
  return Teuchos::rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
}

/// A body of density one (surface density one for shells), its reference point its centre of mass.
template <int dim>
RigidBody<dim> make_body(SurfaceMesh<dim> mesh, const Point<dim>& position, bool closed = true) {
  RigidBody<dim> body;
  const MassProperties<dim> properties = closed ? volume_properties(mesh) : shell_properties(mesh);
  for (auto& vertex : mesh.vertices)
    vertex -= properties.centroid;
  body.name = "body";
  body.closed = closed;
  body.density = 1;
  body.mass = properties.measure;
  body.volume = closed ? properties.measure : 0;
  body.inertia = properties.inertia;
  body.surface = std::move(mesh);
  body.pose.position = position;
  body.initial_pose = body.pose;
  return body;
}

template <int dim>
RigidBody<dim> ball(double radius, const Point<dim>& position, double spacing = 0.7 * h) {
  return make_body<dim>(ball_surface<dim>(radius, spacing), position);
}
template <int dim>
RigidBody<dim> box(double size, const Point<dim>& position, double spacing = 0.7 * h) {
  return make_body<dim>(box_surface<dim>(Point<dim>::Constant(size), spacing), position);
}
template <int dim>
RigidBody<dim> plate(double size, const Point<dim>& position) {
  return make_body<dim>(plate_surface<dim>(Point<dim>::Constant(size), dim - 1, 0.7 * h), position,
                        false);
}
/// Held where it is.
template <int dim>
RigidBody<dim> fixed(RigidBody<dim> body) {
  body.script = [](double) { return ScriptedMotion<dim>(); };
  body.mass = 0;
  return body;
}
template <int dim>
RigidBody<dim> moving(RigidBody<dim> body, const Point<dim>& velocity,
                      const AngularVector<dim>& spin = AngularVector<dim>::Zero()) {
  RigidVector<dim> both;
  both << velocity, spin;
  set_velocity(body, both);
  return body;
}
template <int dim>
RigidBody<dim> rough(RigidBody<dim> body, double friction, double restitution = 0) {
  body.friction = friction;
  body.restitution = restitution;
  return body;
}

/// Solids without fluid: S1 and S2 are their own forces and contact.
template <int dim>
class World {
 public:
  World(std::vector<RigidBody<dim>> bodies, const Point<dim>& gravity,
        std::vector<HalfSpace> walls = {}, const Communicator& comm = world_communicator())
      : contact(GaussSeidelOptions(), std::move(walls), h) {
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(std::make_unique<RigidBodies<dim>>(std::move(bodies), gravity, comm));
    solids = std::make_unique<SolidSystem<dim>>(std::move(models), comm);
  }

  void step(double dt) {
    contact.begin_step(time);
    const auto half = solids->velocity_of(*solids->explicit_momentum(time, dt / 2));
    position_report = contact.resolve(*solids, ContactPhase::position, dt, *half);
    solids->move(*half, time, dt);
    const auto full = solids->velocity_of(*solids->explicit_momentum(time, dt));
    const Momentum<dim> before = momentum_of(*full);
    velocity_report = contact.resolve(*solids, ContactPhase::velocity, dt, *full);
    contact_change = momentum_of(*full) - before;
    solids->set_velocity(*full);
    time += dt;
  }
  void run(double duration, double dt) {
    for (const double end = time + duration - dt / 2; time < end;)
      step(dt);
  }

  SolidState<dim> state(int i) const { return solids->states()[i]; }
  double energy() const {
    double sum = 0;
    for (const auto& one : solids->states())
      sum += one.kinetic_energy;
    return sum;
  }
  Momentum<dim> momentum() const { return momentum_of(*solids->velocity()); }
  Momentum<dim> momentum_of(const Vector& velocity) const {
    const auto stacked = make_vector(solids->map());
    apply(*solids->mass(), velocity, *stacked);
    return solids->momentum(*stacked);
  }
  /// Sum of the sizes of the solids' momenta [kg m/s].
  double momentum_scale() const {
    double sum = 0;
    for (const auto& one : solids->states())
      sum += one.mass * one.velocity.norm();
    return sum;
  }
  /// Deepest overlap at the present positions [m].
  double overlap() {
    const auto velocity = solids->velocity();
    return contact.resolve(*solids, ContactPhase::position, 1e-6, *velocity).deepest_overlap;
  }

  std::unique_ptr<SolidSystem<dim>> solids;
  GaussSeidelContact<dim> contact;
  Momentum<dim> contact_change;  ///< change of the solids' momentum by contact in S2
  ContactReport<dim> position_report, velocity_report;
  double time = 0;
};

/// Lower and upper walls of the cube [0, size]; only the floor if `size` is not given.
template <int dim>
std::vector<HalfSpace> cube_walls(std::optional<double> size = {}) {
  std::vector<HalfSpace> walls;
  for (int axis = 0; axis < dim; ++axis) {
    if (size || axis == dim - 1)
      walls.push_back({2 * axis, axis, 1, 0});
    if (size)
      walls.push_back({2 * axis + 1, axis, -1, *size});
  }
  return walls;
}

template <int dim>
Point<dim> up(double value = 1) {
  return value * Point<dim>::Unit(dim - 1);
}

}  // namespace lockstep::test
