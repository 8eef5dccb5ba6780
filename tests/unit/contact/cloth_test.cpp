#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cloth_world.hpp"
#include "contact/impacts/impact_zones.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class ClothContactsOnRanks : public ::testing::Test {};
/// On one rank: several would each do the same.
template <typename T>
class ClothContacts : public ::testing::Test {
 protected:
  void SetUp() override {
    if (world_communicator()->getSize() > 1)
      GTEST_SKIP();
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(ClothContacts, Dimensions);
TYPED_TEST_SUITE(ClothContactsOnRanks, Dimensions);

/// A simplex of dim + 1 corners that stands on a point below its centre of mass.
template <int dim>
RigidBody<dim> spinning_top(double size, const Point<dim>& lowest, double mass) {
  SurfaceMesh<dim> mesh;
  if constexpr (dim == 2) {
    mesh.vertices = {{0, 0}, {size, size}, {-size, size}};
    mesh.simplices = {{0, 1}, {1, 2}, {2, 0}};
  } else {
    const double s = std::sqrt(0.75) * size;
    mesh.vertices = {{0, 0, 0}, {size, 0, size}, {-0.5 * size, s, size}, {-0.5 * size, -s, size}};
    mesh.simplices = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  }
  const Point<dim> center = volume_properties(mesh).centroid;
  RigidBody<dim> body = make_body<dim>(mesh, lowest + center);
  body.inertia *= mass / body.mass;
  body.mass = mass;
  return body;
}

/// One simplex around the origin with corners at the distance `size`.
template <int dim>
SurfaceMesh<dim> one_simplex(double size) {
  SurfaceMesh<dim> mesh;
  if constexpr (dim == 2) {
    mesh.vertices = {{-size, 0}, {size, 0}};
    mesh.simplices = {{0, 1}};
  } else {
    const double s = std::sqrt(0.75) * size;
    mesh.vertices = {{size, 0, 0}, {-0.5 * size, s, 0}, {-0.5 * size, -s, 0}};
    mesh.simplices = {{0, 1, 2}};
  }
  return mesh;
}

TYPED_TEST(ClothContacts, ABodyAndOneSimplexOfClothGoOnTogether) {
  // Mass 2 at speed 3 hits the middle of a simplex of mass m, which takes part as a whole:
  // 2 * 3 / (2 + m) for both.
  constexpr int dim = TypeParam::value;
  const double half_thickness = 0.05 * h;
  DeformableBody<dim> simplex = cloth<dim>(one_simplex<dim>(2 * h));
  double mass = 0;
  for (const double one : simplex.element_measure)
    mass += one;
  std::vector<DeformableBody<dim>> cloths;
  cloths.push_back(std::move(simplex));
  ClothWorld<dim> world(
      std::move(cloths),
      {moving<dim>(spinning_top<dim>(2 * h, up<dim>(half_thickness), 2), up<dim>(-3))},
      Point<dim>::Zero());
  const auto velocity = rcp(new Vector(*world.solids->velocity(), Teuchos::Copy));
  const Momentum<dim> before = world.momentum_of(*velocity);
  const auto report = world.contact.resolve(*world.solids, ContactPhase::velocity, 0.01, *velocity);
  EXPECT_EQ(report.n_contacts, 1);
  const Momentum<dim> change = world.momentum_of(*velocity) - before;
  EXPECT_LT(change.linear.norm(), 1e-14 * before.linear.norm());
  EXPECT_LT(change.angular.norm(), 1e-14 * before.linear.norm() * h);
  world.solids->set_velocity(*velocity);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(world.state(i).velocity[dim - 1], -6 / (2 + mass), 1e-12) << i;
    EXPECT_NEAR(world.state(i).angular_velocity.norm(), 0, 1e-12) << i;
  }
}

/// Cloth of some length on a plane that is inclined; returns how far and how fast it went.
template <int dim>
std::pair<double, double> slide(double slope, bool on_wall, double time) {
  const double angle = std::atan(slope), friction = 0.5;
  const Point<dim> gravity =
      g * std::sin(angle) * Point<dim>::Unit(0) + up<dim>(-g * std::cos(angle));
  std::vector<DeformableBody<dim>> cloths;
  cloths.push_back(sheet<dim>(4 * h, up<dim>(0.06 * h), h, 1e4));
  cloths.back().friction = friction;
  std::vector<RigidBody<dim>> ground;
  if (!on_wall)
    ground.push_back(rough(fixed(box<dim>(40 * h, up<dim>(-20 * h), 10 * h)), friction));
  ClothWorld<dim> world(std::move(cloths), ground, gravity,
                        on_wall ? cube_walls<dim>() : std::vector<HalfSpace>());
  while (world.time < time - 1e-9)
    world.step(0.01);
  EXPECT_GT(world.state(0).center_of_mass[dim - 1], 0);
  return {world.state(0).center_of_mass[0], world.state(0).velocity[0]};
}

TYPED_TEST(ClothContacts, ASheetOnAnInclineSticksOrSlides) {
  constexpr int dim = TypeParam::value;
  const double time = 0.4, angle = std::atan(0.6);
  const double acceleration = g * (std::sin(angle) - 0.5 * std::cos(angle));
  for (const bool on_wall : {true, false}) {
    EXPECT_LT(std::abs(slide<dim>(0.45, on_wall, time).first), 1e-2 * h) << on_wall;
    const auto [distance, speed] = slide<dim>(0.6, on_wall, time);
    EXPECT_NEAR(speed, acceleration * time, 0.02 * acceleration * time) << on_wall;
    EXPECT_NEAR(distance, acceleration * time * time / 2, 0.05 * h) << on_wall;
  }
}

/// A line on end. Pushed through M_S only the end stops that meets the floor; with the response of
/// stiff forces, at a step far longer than they need, all of it does.
TEST(ContactResponse, StiffSolidsArePushedAsAWhole) {
  SurfaceMesh<2> line;
  line.vertices = {{0, h}, {0, 2 * h}, {0, 3 * h}};
  line.simplices = {{0, 1}, {1, 2}};
  std::vector<DeformableBody<2>> cloths;
  cloths.push_back(cloth<2>(line, 1e9));
  ClothWorld<2> world(std::move(cloths), {}, Point<2>::Zero(), {{2, 1, 1.0, 0}});
  const double dt = 1, speed = 1.5 * h;
  const auto resolved = [&](const ContactResponse& response, RCP<const Vector>* impulse) {
    const auto velocity = make_vector(world.solids->map());
    const auto falling = rcp(new Vector(*velocity, Teuchos::Copy));
    std::vector<double> values(6, 0);
    for (int node = 0; node < 3; ++node)
      values[2 * node + 1] = -speed;
    falling->update(1, *distributed(*world.solids, values), 0);
    const auto report =
        world.contact.resolve(*world.solids, ContactPhase::position, dt, *falling, response);
    if (impulse)
      *impulse = report.impulse;
    EXPECT_EQ(report.n_contacts, 1);
    return replicated(*world.solids, *falling);
  };
  const std::vector<double> alone = resolved({}, nullptr);
  EXPECT_NEAR(*std::min_element(alone.begin(), alone.end()), -speed, 1e-12);
  RCP<const Vector> impulse;
  const std::vector<double> whole = resolved(
      [&] { return exact_inverse(world.solids->solid_block(Teuchos::null, dt / 2), "solids"); },
      &impulse);
  const double left = 0.95 * h;  // the skin is h/10 thick
  for (int node = 0; node < 3; ++node)
    EXPECT_NEAR(whole[2 * node + 1], -left / dt, 1e-6 * speed) << node;
  const double mass = world.state(0).mass;
  EXPECT_NEAR(world.solids->momentum(*impulse).linear.y(), mass * (speed - left / dt), 1e-6 * mass);
}

TEST(ClothContacts3D, AClothFallsOnABallAndFoldsWithoutCrossing) {
  if (world_communicator()->getSize() > 1)
    GTEST_SKIP();
  std::vector<DeformableBody<3>> cloths;
  cloths.push_back(sheet<3>(16 * h, up<3>(4.5 * h), 1.2 * h, 30));
  cloths.back().friction = 0.3;
  ClothWorld<3> world(std::move(cloths),
                      {rough(fixed(ball<3>(4 * h, Point<3>::Zero(), 1.5 * h)), 0.3)}, up<3>(-g),
                      {{4, 2, 1, -5 * h}});
  int n_contacts = 0;
  for (int i = 0; i < 70; ++i) {
    world.step(0.01);
    ASSERT_EQ(n_crossings(*world.solids), 0) << "step " << i;
    EXPECT_EQ(world.position_report.n_crossings, 0);
    n_contacts = std::max(n_contacts, world.position_report.n_contacts);
  }
  EXPECT_GT(n_contacts, 100);
}

TYPED_TEST(ClothContacts, WildMotionDoesNotCross) {
  // Every node has a random velocity of up to ten edges a step: impact zones are at work.
  constexpr int dim = TypeParam::value;
  std::vector<DeformableBody<dim>> cloths;
  for (int i = 0; i < 2; ++i)
    cloths.push_back(sheet<dim>((dim == 2 ? 20 : 6) * h, up<dim>((1 + i) * h), h, 1));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> speed(-60, 60);
  for (auto& one : cloths) {
    for (auto& velocity : one.velocity) {
      for (int a = 0; a < dim; ++a)
        velocity[a] = speed(random);
    }
  }
  ClothWorld<dim> world(std::move(cloths), {ball<dim>(2 * h, up<dim>(-3 * h))}, Point<dim>::Zero());
  for (int i = 0; i < 20; ++i) {
    world.step(0.01);
    ASSERT_EQ(n_crossings(*world.solids), 0) << "step " << i;
    EXPECT_EQ(world.position_report.n_crossings, 0);
  }
}

TYPED_TEST(ClothContacts, ImpactZonesGoWithNodesThatAreMoved) {
  // A sheet that a script or a rigid body lifts by two edges in a step passes one at rest, half an
  // edge above it, unless that goes with it.
  constexpr int dim = TypeParam::value;
  const double dt = 0.01;
  const Point<dim> lift = up<dim>(2 * h / dt);
  for (const auto& [by_a_body, is_seen] :
       {std::pair(false, false), std::pair(true, true), std::pair(true, false)}) {
    std::vector<DeformableBody<dim>> cloths;
    for (int i = 0; i < 2; ++i)
      cloths.push_back(sheet<dim>((5 - i) * h, up<dim>(0.5 * i * h), h));
    std::vector<RigidBody<dim>> bodies;
    if (by_a_body) {
      bodies.push_back(ball<dim>(2 * h, up<dim>(-10 * h)));
      bodies.back().seen_by_fluid = is_seen;
    }
    for (int n = 0; n < cloths[0].n_nodes(); ++n) {
      if (by_a_body)
        cloths[0].attached.emplace_back(n, bodies[0].name);
      cloths[0].locked[n].fill(!by_a_body);
    }
    ClothWorld<dim> world(std::move(cloths), bodies, Point<dim>::Zero());
    ContactTopology<dim> topology;
    const ContactShapes<dim> shapes(*world.solids, topology);
    std::vector<double> velocity = replicated(*world.solids, *world.solids->velocity());
    VelocityRow<dim> row;
    const auto set = [&] {
      for (std::size_t k = 0; k < row.dofs.size(); ++k)
        velocity[row.dofs[k]] = row.coefficients[k].dot(lift);
    };
    if (by_a_body) {
      world.solids->rigid_row(2, up<dim>(-10 * h), row);
      set();
    }
    const SolidDescription& pinned = shapes.solids()[0];
    for (int v = pinned.vertex_begin; v < pinned.vertex_end && !by_a_body; ++v) {
      world.solids->velocity_row(shapes.at_vertex(v), shapes.mesh().vertices[v], row);
      set();
    }
    EXPECT_EQ(join_impact_zones(*world.solids, shapes, replicated_inverse_mass(*world.solids), dt,
                                velocity)
                  .n_left,
              0);
    const SolidMotion<dim> motion(*world.solids, shapes, velocity);
    for (int v = shapes.solids()[1].vertex_begin; v < shapes.solids()[1].vertex_end; ++v)
      EXPECT_LT((motion.of_vertex(1, v) - lift).norm(), 1e-12 * lift.norm())
          << v << by_a_body << is_seen;
  }
}

/// Two sheets, one of them pinned at a side, and rigid bodies, in a box with walls. Bodies and
/// sheets are not in line: which of two contacts comes first must not be for round-off to say.
template <int dim>
ClothWorld<dim> crowd(const Communicator& comm) {
  std::vector<DeformableBody<dim>> cloths;
  for (int i = 0; i < 2; ++i) {
    Point<dim> center = Point<dim>::Constant((5 + 0.083 * i) * h) + up<dim>(2 * i * h);
    cloths.push_back(sheet<dim>(8 * h, center, 1.3 * h));
    cloths.back().friction = 0.4;
    cloths.back().consistent_mass = i == 1;
  }
  for (int n = 0; n < cloths[0].n_nodes(); ++n) {
    if (cloths[0].position[n][0] < 1.5 * h)
      cloths[0].locked[n].fill(true);
  }
  std::vector<RigidBody<dim>> bodies;
  for (int i = 0; i < 2; ++i) {
    Point<dim> position = Point<dim>::Constant(5 * h) + up<dim>((i == 0 ? -2 : 5) * h);
    for (int a = 0; a < dim; ++a)
      position[a] += (0.137 + 0.053 * a + 1.071 * i) * h;
    bodies.push_back(rough(moving<dim>(ball<dim>(1.5 * h, position), up<dim>(i == 0 ? 4 : -4),
                                       AngularVector<dim>::Constant(5)),
                           0.4));
  }
  return ClothWorld<dim>(std::move(cloths), bodies, up<dim>(-g), cube_walls<dim>(10 * h), {}, comm);
}

TYPED_TEST(ClothContactsOnRanks, ImpulsesBalanceAndDoNotDependOnTheNumberOfRanks) {
  constexpr int dim = TypeParam::value;
  ClothWorld<dim> together = crowd<dim>(world_communicator()),
                  alone = crowd<dim>(own_communicator());
  int n_contacts = 0, n_compared = 0;
  double given = 0;
  bool alike = true;
  for (int i = 0; i < 30; ++i) {
    together.step(0.01);
    alone.step(0.01);
    // Walls and pins give what the report says, and nothing else changes momentum.
    const Momentum<dim> change = together.contact_change;
    const Momentum<dim> external = together.velocity_report.external_impulse;
    double scale = external.linear.norm();
    for (const auto& state : together.solids->states())
      scale += state.mass * std::max(1.0, state.velocity.norm());
    EXPECT_LT((change.linear - external.linear).norm(), 1e-12 * scale);
    EXPECT_LT((change.angular - external.angular).norm(), 1e-12 * scale);
    n_contacts += together.velocity_report.n_contacts;
    given += external.linear.norm();
    ASSERT_EQ(n_crossings(*together.solids), 0) << "step " << i;
    // Sums in another order may take an iteration across its tolerance one step earlier, and what
    // differs then grows where friction does not converge: the beginning is compared, and while
    // both take the same iterations.
    alike = alike && i < 12 &&
            together.velocity_report.iterations == alone.velocity_report.iterations &&
            together.position_report.iterations == alone.position_report.iterations;
    n_compared += alike;
    for (int k = 0; alike && k < 4; ++k) {
      EXPECT_LT((together.state(k).center_of_mass - alone.state(k).center_of_mass).norm(), 1e-9 * h)
          << "step " << i;
    }
  }
  EXPECT_GE(n_compared, 10);
  EXPECT_GT(n_contacts, 50);
  EXPECT_GT(given, 0);
}

}  // namespace
}  // namespace lockstep::test
