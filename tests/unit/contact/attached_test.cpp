// Surfaces that rigid bodies carry, and those that turn about a pivot.
#include <gtest/gtest.h>

#include <map>

#include "cloth_world.hpp"
#include "contact/impacts/impact_zones.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class Carried : public ::testing::Test {
 protected:
  void SetUp() override {
    if (world_communicator()->getSize() > 1)
      GTEST_SKIP();
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Carried, Dimensions);

/// With its reference point moved by `shift`: it turns about that.
template <int dim>
RigidBody<dim> pivoted(RigidBody<dim> body, const Point<dim>& shift) {
  for (auto& vertex : body.surface.vertices)
    vertex -= shift;
  body.center_of_mass -= shift;
  body.pose.position += shift;
  body.initial_pose = body.pose;
  return body;
}

/// A step of a radian: of a body about its pivot, of a scripted one, and of a sheet that the first
/// of them carries, twice as far from the pivot as the body.
TYPED_TEST(Carried, PathsEndWhereAStepMovesTheSurfaces) {
  constexpr int dim = TypeParam::value;
  const double dt = 0.5;
  const Point<dim> along = Point<dim>::Unit(0);
  const AngularVector<dim> spin = 2 * AngularVector<dim>::Unit(n_rotations<dim> - 1);
  std::vector<RigidBody<dim>> bodies{
      moving<dim>(pivoted<dim>(box<dim>(2 * h, Point<dim>::Zero()), -3 * h * along), h * along,
                  spin),
      pivoted<dim>(box<dim>(2 * h, up<dim>(20 * h)), 3 * h * along)};
  bodies[0].name = "carrier";
  bodies[1].script = uniform_motion<dim>(-h * along, spin);
  std::vector<DeformableBody<dim>> cloths;
  cloths.push_back(sheet<dim>(2 * h, 3 * h * along, h));
  for (int n = 0; n < cloths[0].n_nodes(); ++n)
    cloths[0].attached.emplace_back(n, "carrier");
  ClothWorld<dim> world(std::move(cloths), bodies, Point<dim>::Zero());
  ContactTopology<dim> topology;
  const ContactShapes<dim> shapes(*world.solids, topology);
  const auto velocity = world.solids->velocity();
  const SolidMotion<dim> motion(*world.solids, shapes, replicated(*world.solids, *velocity));
  const SurfacePath<dim> path(shapes, motion, dt);
  world.solids->move(*velocity, 0, dt);
  const auto moved = world.solids->snapshot();
  ASSERT_EQ(path.after.size(), moved->mesh().vertices.size());
  for (std::size_t v = 0; v < path.after.size(); ++v) {
    EXPECT_LT((path.after[v] - moved->mesh().vertices[v]).norm(), 1e-12 * h) << v;
    EXPECT_GT((path.after[v] - path.before[v]).norm(), 0.1 * h) << v;
  }
}

/// Lumped masses stand in for consistent ones, with what a body gets of the nodes that it carries.
TYPED_TEST(Carried, ConsistentMassesAreLumpedBeforeABodyTakesThemUp) {
  constexpr int dim = TypeParam::value;
  std::vector<InverseMass> inverse;
  for (const bool is_consistent : {true, false}) {
    std::vector<DeformableBody<dim>> cloths;
    cloths.push_back(sheet<dim>((dim == 2 ? 60 : 6) * h, Point<dim>::Zero(), h));
    cloths[0].consistent_mass = is_consistent;
    for (int n = 0; n < cloths[0].n_nodes(); ++n) {
      if (cloths[0].position[n][0] < -2.5 * h)
        cloths[0].attached.emplace_back(n, "body");
    }
    const Point<dim> place = -3 * h * Point<dim>::Unit(0);
    ClothWorld<dim> world(std::move(cloths), {ball<dim>(h, place)}, Point<dim>::Zero());
    inverse.push_back(replicated_inverse_mass(*world.solids));
    EXPECT_EQ(inverse.back().exact, !is_consistent);
  }
  ASSERT_EQ(inverse[0].rows.size(), inverse[1].rows.size());
  for (std::size_t row = 0; row < inverse[0].rows.size(); ++row) {
    const double size = inverse[1].rows[row].empty() ? 0 : inverse[1].rows[row].front().second;
    std::map<int, double> difference;
    for (const auto& [dof, value] : inverse[0].rows[row])
      difference[dof] += value;
    for (const auto& [dof, value] : inverse[1].rows[row])
      difference[dof] -= value;
    for (const auto& [dof, value] : difference)
      EXPECT_NEAR(value, 0, 1e-12 * std::abs(size)) << row << ", " << dof;
  }
}

/// A line that is glued into a box goes out of it, round a corner and with its end into it again:
/// only there they touch.
TEST(CarriedLine, TouchesItsCarrierWhereItIsNotGlued) {
  if (world_communicator()->getSize() > 1)
    GTEST_SKIP();
  SurfaceMesh<2> line;
  line.vertices = {{-0.3 * h, h}, {-0.1 * h, h}, {h, h}, {h, 0}, {-0.1 * h, 0}};
  line.simplices = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  std::vector<DeformableBody<2>> cloths;
  cloths.push_back(cloth<2>(line));
  cloths[0].attached.emplace_back(0, "body");
  ClothWorld<2> world(std::move(cloths), {box<2>(4 * h, {-2 * h, 0}, 4 * h)}, Point<2>::Zero());
  const double dt = 0.01;
  const auto velocity = rcp(new Vector(*world.solids->velocity(), Teuchos::Copy));
  const auto report = world.contact.resolve(*world.solids, ContactPhase::position, dt, *velocity);
  EXPECT_EQ(report.n_contacts, 1);
  EXPECT_NEAR(report.deepest_overlap, (0.1 + 0.05) * h, 1e-12);  // with half of the skin
  // The neighbour of the glued node is as deep, and goes nowhere.
  const std::vector<double> resolved = replicated(*world.solids, *velocity);
  EXPECT_EQ(resolved[2], 0);
  EXPECT_GT(resolved[8], 0.01 * h / dt);
}

/// A node falls on the middle of a segment twice as heavy, whose mass is consistent: all three go
/// on with the mean velocity of nodes of equal mass.
TEST(ImpactZones, NodesOfConsistentMassWeighWhatTheyDo) {
  if (world_communicator()->getSize() > 1)
    GTEST_SKIP();
  SurfaceMesh<2> upright;
  upright.vertices = {{0, h}, {0, 3 * h}};
  upright.simplices = {{0, 1}};
  std::vector<DeformableBody<2>> cloths;
  cloths.push_back(cloth<2>(upright));
  cloths.push_back(sheet<2>(4 * h, Point<2>::Zero(), 9 * h));
  cloths[1].consistent_mass = true;
  ClothWorld<2> world(std::move(cloths), {}, Point<2>::Zero());
  ContactTopology<2> topology;
  const ContactShapes<2> shapes(*world.solids, topology);
  const double dt = 0.01, fall = -2 * h / dt;
  std::vector<double> velocity{0, fall, 0, fall, 0, 0, 0, 0};
  EXPECT_EQ(
      join_impact_zones(*world.solids, shapes, replicated_inverse_mass(*world.solids), dt, velocity)
          .n_left,
      0);
  const std::vector<double> expected{0, fall / 3, 0, fall, 0, fall / 3, 0, fall / 3};
  for (int k = 0; k < 8; ++k)
    EXPECT_NEAR(velocity[k], expected[k], 1e-12 * -fall) << k;
}

}  // namespace
}  // namespace lockstep::test
