// The model behind its interface: rows, gravity, momentum, checkpoints; on any number of ranks.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <filesystem>

#include "coupling/solid_system.hpp"
#include "output/checkpoint.hpp"
#include "rigid/register_rigid.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

const std::string small_ball = geometry("ball", number("Radius", "0.2"));

/// Five bodies, one of them scripted.
std::vector<std::string> zoo() {
  return {small_ball + number("Density", "2") + numbers("Velocity", "1, 0, 0"),
          geometry("box", numbers("Size", "0.3, 0.4, 0.5")) + number("Density", "3") +
              numbers("Position", "2, 0, 1") + numbers("Angular Velocity", "1, 2, 3") +
              numbers("Pivot", "0.1, 0, 0"),
          small_ball + motion("sinusoid", numbers("Amplitude", "0, 1, 0") +
                                              numbers("Angular Amplitude", "0.3, 0, 0") +
                                              number("Frequency", "0.5")),
          geometry("plate", numbers("Size", "1, 0, 1") + text("Normal", "y")) +
              number("Surface Density", "1") + numbers("Position", "0, 3, 0") +
              texts("Locked", "x, y, z, rotation x") + numbers("Angular Velocity", "0, 1, 2"),
          geometry("torus", number("Radius", "0.5") + number("Tube Radius", "0.2")) +
              number("Mass", "4") + numbers("Velocity", "0, 0, 2")};
}

template <int dim>
SurfacePoint<dim> point_of(const RigidBodies<dim>& bodies, int solid) {
  SurfacePoint<dim> point;
  point.simplex = bodies.solids()[solid].simplex_begin;
  return point;
}

TEST(RigidBodies, RowsAreTheRigidVelocityFieldAtTheGivenPoint) {
  const auto bodies = model<3>(zoo());
  const Point<3> x(0.4, -1, 2);
  const std::vector<double> own = [&] {
    const auto v = bodies->velocity()->getData();
    return std::vector<double>(v.begin(), v.end());
  }();
  const std::vector<double> all = gather_all(world(), own);
  ASSERT_EQ(all.size(), 24u);
  for (const int solid : {0, 1, 3, 4}) {
    VelocityRow<3> row;
    bodies->velocity_row(point_of(*bodies, solid), x, row);
    ASSERT_EQ(row.dofs.size(), 6u);
    Point<3> velocity = Point<3>::Zero();
    for (int k = 0; k < 6; ++k)
      velocity += all[row.dofs[k]] * row.coefficients[k];
    const auto& b = bodies->bodies()[solid];
    const Point<3> expected = b.linear_velocity() + b.angular_velocity().cross(x - b.pose.position);
    EXPECT_LE((velocity - expected).norm(), 1e-14);
    EXPECT_EQ(bodies->prescribed_velocity(point_of(*bodies, solid), x), Point<3>(0, 0, 0));
  }
  VelocityRow<3> row;
  bodies->velocity_row(point_of(*bodies, 2), x, row);
  EXPECT_TRUE(row.dofs.empty());
  // d/dt sin(pi t) at 0 is pi: the ball rises at pi and turns at 0.3 pi about x.
  EXPECT_LE(
      (bodies->prescribed_velocity(point_of(*bodies, 2), {0, 0, 1}) - Point<3>(0, pi - 0.3 * pi, 0))
          .norm(),
      1e-13);
}

TEST(RigidBodies, DescribesItsSolids) {
  const auto bodies = model<3>(zoo());
  const auto& solids = bodies->solids();
  ASSERT_EQ(solids.size(), 5u);
  EXPECT_TRUE(solids[2].prescribed && !solids[1].prescribed);
  EXPECT_TRUE(solids[1].closed && !solids[3].closed);
  for (int s = 1; s < 5; ++s)
    EXPECT_EQ(solids[s].simplex_begin, solids[s - 1].simplex_end);
  EXPECT_EQ(solids[4].vertex_end, static_cast<int>(bodies->surface().vertices.size()));
  // The plate at y = 3.
  for (int v = solids[3].vertex_begin; v < solids[3].vertex_end; ++v)
    EXPECT_EQ(bodies->surface().vertices[v].y(), 3);
}

TEST(RigidBodies, GravityActsAtTheCentreOfMass) {
  const Point<2> gravity(0, -10);
  const auto bodies =
      model<2>({geometry("plate", numbers("Size", "2, 0") + text("Normal", "y")) +
                number("Mass", "3") + numbers("Pivot", "-1, 0") + numbers("Position", "7, 2")},
               gravity);
  const auto momentum = make_vector(bodies->dof_map());
  bodies->explicit_momentum(0, 0.5, *momentum);
  const auto each = bodies->momentum_of_each(*momentum);
  const auto impulse = bodies->external_impulse(0, 0.5);
  EXPECT_NEAR(impulse.linear.y(), -15, 1e-13);
  EXPECT_NEAR(impulse.angular(0), 7 * -15.0, 1e-12);
  EXPECT_LE((each[0].linear - impulse.linear).norm(), 1e-13);
  EXPECT_NEAR(each[0].angular(0), impulse.angular(0), 1e-12);
}

TEST(RigidBodies, ConstantLoadsActAtTheCentreOfMass) {
  const auto bodies =
      model<2>({geometry("plate", numbers("Size", "2, 0") + text("Normal", "y")) +
                number("Mass", "3") + numbers("Pivot", "-1, 0") + numbers("Position", "7, 2") +
                numbers("Force", "2, 3") + number("Torque", "5")});
  const auto momentum = make_vector(bodies->dof_map());
  bodies->explicit_momentum(0, 0.5, *momentum);
  const auto each = bodies->momentum_of_each(*momentum);
  const auto impulse = bodies->external_impulse(0, 0.5);
  EXPECT_NEAR(impulse.linear.x(), 1, 1e-13);
  EXPECT_NEAR(impulse.linear.y(), 1.5, 1e-13);
  EXPECT_NEAR(impulse.angular(0), 7 * 1.5 - 2 * 1 + 2.5, 1e-12);
  EXPECT_LE((each[0].linear - impulse.linear).norm(), 1e-13);
  EXPECT_NEAR(each[0].angular(0), impulse.angular(0), 1e-12);
}

/// Steps of one disc of mass 1 and inertia 1 without fluid; by step its place and velocity.
std::vector<std::pair<double, double>> path_of(const std::string& load_list, double dt,
                                               int n_steps) {
  const auto bodies = model<2>({small_ball + number("Mass", "1") + number("Inertia", "1") +
                                numbers("Position", "1, 0") + load_list});
  std::vector<std::pair<double, double>> path;
  for (int step = 0; step < n_steps; ++step) {
    const double time = step * dt;
    const auto velocity = make_vector(bodies->dof_map());
    bodies->begin_step(time, dt);
    bodies->explicit_momentum(time, dt / 2, *velocity);
    bodies->move(*velocity, time, dt);
    bodies->explicit_momentum(time, dt, *velocity);
    bodies->set_velocity(*velocity);
    path.emplace_back(bodies->states()[0].center_of_mass.x(), bodies->states()[0].velocity.x());
  }
  return path;
}

TEST(RigidBodies, ALoadThatGrowsLinearlyMovesABodyExactly) {
  // x = 1 + t^3 / 3, v = t^2 under a force of 2 t.
  for (const std::string& ramp :
       {texts("Force", "table(t, 0, 0, 1, 2), 0"), texts("Force", "2*t, 0")}) {
    const auto path = path_of(ramp, 0.1, 10);
    EXPECT_NEAR(path.back().first, 1 + 1. / 3, 1e-14);
    EXPECT_NEAR(path.back().second, 1, 1e-14);
  }
}

TEST(RigidBodies, AForceByFormulaIsASpringOfSecondOrder) {
  // x = cos 2 t; ten periods. Each step keeps x^2 + (1 - dt^2) v^2 / 4, or gains nothing.
  const auto error = [](int n_steps) {
    const auto path = path_of(texts("Force", "-4*x, 0"), 10 * pi / n_steps, n_steps);
    double largest = 0;
    for (const auto& [x, v] : path)
      largest = std::max(largest, std::abs(x));
    EXPECT_LT(largest, 1 + 1e-12);
    EXPECT_GT(*std::max_element(path.end() - n_steps / 10, path.end()), std::make_pair(0.999, 0.));
    return std::hypot(path.back().first - 1, path.back().second / 2);
  };
  const double coarse = error(1000), fine = error(2000);
  EXPECT_LT(fine, 1e-2);
  EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1);
}

TEST(RigidBodies, ATorqueByFormulaTurnsABody) {
  const auto bodies = model<2>({small_ball + number("Mass", "1") + numbers("Position", "3, 1") +
                                text("Torque", "x + 10*y + 100*t")});
  const auto impulse = bodies->external_impulse(0.5, 0.3);  // before the body moves: at .5 + .2 s
  EXPECT_NEAR(impulse.angular(0), 0.3 * (13 + 70), 1e-12);
  EXPECT_EQ(impulse.linear, Point<2>(0, 0));
}

TEST(RigidBodies, MomentumOfVelocityIsThatOfTheBodies) {
  const auto bodies = model<3>(zoo());
  const auto momentum = make_vector(bodies->dof_map());
  apply(*bodies->mass(), *bodies->velocity(), *momentum);
  const auto other = make_vector(bodies->dof_map());
  bodies->explicit_momentum(0, 0.1, *other);  // no gravity: M V
  other->update(-1, *momentum, 1);
  EXPECT_LE(other->normInf(), 1e-13);
  const auto each = bodies->momentum_of_each(*momentum);
  const auto states = bodies->states();
  for (const int b : {0, 1, 3, 4})
    EXPECT_LE((each[b].linear - states[b].mass * states[b].velocity).norm(), 1e-12);
  EXPECT_EQ(each[2].linear.norm() + each[2].angular.norm(), 0);
  // The torus flies at 2 m/s through the origin.
  EXPECT_NEAR(states[4].kinetic_energy, 8, 1e-12);
  EXPECT_NEAR(each[4].linear.z(), 8, 1e-12);
}

TEST(RigidBodies, LocksAreTheNamedDofs) {
  const auto bodies = model<3>(zoo());
  const auto mine = bodies->locked_dofs();
  // Body 3 is the third dynamic one: dofs 12 to 17; x, y, z, rotation x.
  EXPECT_EQ(gather_all(world(), mine), (std::vector<GlobalIndex>{12, 13, 14, 15}));
}

TEST(RigidBodies, EffectiveVelocityIsTheTwistOfTheMove) {
  const auto bodies = model<3>(zoo());
  const double dt = 0.25;
  const auto surface_before = bodies->surface();
  bodies->move(*bodies->velocity(), 0, dt);
  EXPECT_EQ(bodies->time(), dt);
  for (int s = 0; s < 5; ++s) {
    const auto& solid = bodies->solids()[s];
    const Twist<3>& twist = bodies->bodies()[s].last_move;
    EXPECT_EQ(bodies->effective_velocity(point_of(*bodies, s), {1, 2, 3}),
              twist.velocity({1, 2, 3}));
    const Point<3> x = followed<3>(twist, surface_before.vertices[solid.vertex_begin], dt);
    EXPECT_LE((x - bodies->surface().vertices[solid.vertex_begin]).norm(), 1e-10) << s;
  }
  // Pure translation: exactly its velocity.
  EXPECT_EQ(bodies->effective_velocity(point_of(*bodies, 0), {5, 5, 5}), Point<3>(1, 0, 0));
}

TEST(RigidBodies, SystemStacksThemAndRanksAgree) {
  std::vector<std::unique_ptr<SolidModel<3>>> models;
  models.push_back(model<3>(zoo(), {0, 0, -1}));
  SolidSystem<3> solids(std::move(models), world());
  for (int i = 0; i < 3; ++i) {
    const double dt = 0.1;
    const auto half = solids.explicit_momentum(i * dt, dt / 2);
    solids.add_midpoint_correction(dt / 2, *half);
    solids.move(*solids.velocity_of(*half), i * dt, dt);
    solids.set_velocity(*solids.velocity_of(*solids.explicit_momentum(i * dt, dt)));
  }
  // The ball falls: v = -g t, and every rank has the same state.
  const auto states = solids.states();
  EXPECT_NEAR(states[0].velocity.z(), -0.3, 1e-13);
  for (const auto& state : states) {
    const double number = state.center_of_mass.sum() + state.angular_velocity.sum();
    EXPECT_EQ(min_all(world(), number), max_all(world(), number));
  }
}

TEST(RigidBodies, ScriptsStartAtTheStartTime) {
  const std::string disc = geometry("ball", number("Radius", "0.2"));
  const auto bodies = make_rigid_bodies<2>(
      {{"disc", body_list<2>(disc + numbers("Position", "1, 0") + motion("constant velocity") +
                             numbers("Velocity", "2, 0"))}},
      grid_spacing, Point<2>(0, 0), world(), 0.5);
  EXPECT_LE((bodies->bodies()[0].pose.position - Point<2>(2, 0)).norm(), 1e-15);
  EXPECT_EQ(bodies->dof_map()->getGlobalNumElements(), 0u);
}

TEST(RigidBodies, CheckpointRestoresBitForBit) {
  const std::string folder = (std::filesystem::temp_directory_path() /
                              ("lockstep_rigid_" + std::to_string(world()->getSize())))
                                 .string();
  if (is_root(world()))
    std::filesystem::create_directories(folder);
  world()->barrier();
  const auto saved = model<3>(zoo()), loaded = model<3>(zoo());
  saved->move(*saved->velocity(), 0, 0.3);
  {
    CheckpointWriter writer(world(), folder, {1, 0.3, "<ParameterList/>"});
    saved->save(writer);
    writer.finish(1);
  }
  loaded->load(CheckpointReader(world(), latest_checkpoint(folder)));
  EXPECT_EQ(loaded->time(), saved->time());
  for (int b = 0; b < 5; ++b) {
    const auto &p = saved->bodies()[b], &q = loaded->bodies()[b];
    EXPECT_EQ(p.pose.position, q.pose.position);
    EXPECT_EQ(p.pose.orientation.coeffs(), q.pose.orientation.coeffs());
    EXPECT_EQ(p.velocity, q.velocity);
    EXPECT_EQ(p.momentum, q.momentum);
  }
  EXPECT_EQ(saved->surface().vertices, loaded->surface().vertices);
  const auto others = model<3>({small_ball + number("Density", "1")});
  EXPECT_THROW(others->load(CheckpointReader(world(), latest_checkpoint(folder))), InputError);
  world()->barrier();
  if (is_root(world()))
    std::filesystem::remove_all(folder);
}

TEST(RigidBodies, RegistryMakesOneModelOfAllBodies) {
  SolidRegistry<2> registry("solid");
  register_rigid<2>(registry);
  const std::string disc = geometry("ball", number("Radius", "0.2")) + number("Density", "1");
  const NamedLists bodies{{"Left", body_list<2>(disc)}, {"Right", body_list<2>(disc)}};
  SolidSetting<2> setting;
  setting.smallest_length = 0.1;
  setting.comm = world();
  const auto made = registry.create("rigid body", ParameterList(), bodies, setting);
  ASSERT_EQ(made->solids().size(), 2u);
  EXPECT_EQ(made->solids()[0].name, "Left");
  EXPECT_EQ(made->solids()[1].name, "Right");
}

}  // namespace
}  // namespace lockstep::test
