// Hits of segments, closest points, and surfaces that sweep over points.
#include "support.hpp"

namespace lockstep::test {
namespace {

std::vector<int> all_of(int n) {
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i)
    all[i] = i;
  return all;
}

TEST(FirstHit, FacesOfABox) {
  const auto box = snapshot<3>({box_surface<3>({1, 1, 1}, 0.4)});
  const auto hit = box.first_hit({-2, .1, .2}, {2, .1, .2});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 1.5 / 4, 1e-15);
  EXPECT_NEAR((hit->position - Point<3>(-.5, .1, .2)).norm(), 0, 1e-15);
  EXPECT_FALSE(box.first_hit({-2, .1, .2}, {-.51, .1, .2}));
  EXPECT_TRUE(box.first_hit({-2, .1, .2}, {-.51, .1, .2}, 0.02));
  EXPECT_TRUE(box.first_hit({-2, .1, .2}, {-.5, .1, .2}));  // touches
  EXPECT_TRUE(box.first_hit({-.5, .1, .2}, {-2, .1, .2}));  // starts on the surface
  EXPECT_FALSE(box.first_hit({-2, .51, 0}, {2, .51, 0}));   // passes by
  EXPECT_TRUE(box.first_hit({-2, .51, 0}, {2, .51, 0}, .02));
  const auto along = box.first_hit({-2, .5, .2}, {2, .5, .2});  // runs in the plane of a side
  ASSERT_TRUE(along);
  EXPECT_NEAR(along->fraction, 1.5 / 4, 1e-11);
  EXPECT_FALSE(box.first_hit({0, 0, 0}, {.2, .2, .2}));
  EXPECT_FALSE(box.first_hit({0, 0, 0}, {0, 0, 0}));
  EXPECT_TRUE(box.first_hit({.5, 0, 0}, {.5, 0, 0}));
}

TEST(FirstHit, Segments) {
  const auto plate = snapshot<2>({plate_surface<2>({2, 0}, 1, 5)}, false);  // y = 0, |x| <= 1
  const auto hit = plate.first_hit({.5, -1}, {.5, 3});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 0.25, 1e-15);
  EXPECT_NEAR((hit->position - Point<2>(.5, 0)).norm(), 0, 1e-15);
  EXPECT_TRUE(plate.first_hit({1, -1}, {1, 1}));
  EXPECT_FALSE(plate.first_hit({1.01, -1}, {1.01, 1}));
  EXPECT_TRUE(plate.first_hit({1.01, -1}, {1.01, 1}, 0.02));
  const auto along = plate.first_hit({-3, 0}, {1, 0});
  ASSERT_TRUE(along);
  EXPECT_NEAR(along->fraction, 0.5, 1e-11);
}

TEST(FirstHit, NothingSlipsThroughEdgesAndVertices) {
  const auto mesh = moved<3>(ball_surface<3>(1, 0.3), {.3, .1, -.2}, 2);
  const auto ball = snapshot<3>({mesh});
  const Point<3> center(.3, .1, -.2);
  for (const auto& triangle : mesh.simplices)
    for (int k = 0; k < 3; ++k) {
      const Point<3> p = mesh.vertices[triangle[k]], q = mesh.vertices[triangle[(k + 1) % 3]];
      for (const double t : {0.0, 0.1, 1 / 3.0, 0.7}) {
        const Point<3> x = (1 - t) * p + t * q;
        EXPECT_TRUE(ball.first_hit(center, center + 1.5 * (x - center)));
        EXPECT_TRUE(ball.first_hit(center + Point<3>(.1, .2, .3), x + 0.01 * (x - center)));
      }
    }
}

TEST(Closest, FaceEdgeAndCorner) {
  const auto box = snapshot<3>(
      {box_surface<3>({1, 1, 1}, 0.4), moved<3>(box_surface<3>({1, 1, 1}, 0.4), {3, 0, 0})});
  const auto face = box.closest({.7, .1, .2}, 1);
  ASSERT_TRUE(face);
  EXPECT_NEAR(face->fraction, .2, 1e-15);
  EXPECT_NEAR((face->position - Point<3>(.5, .1, .2)).norm(), 0, 1e-15);
  const auto corner = box.closest({1.5, 1.5, 1.5}, 2);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->fraction, std::sqrt(3.0), 1e-15);
  EXPECT_FALSE(box.closest({1.5, 1.5, 1.5}, 1.7));
  EXPECT_NEAR(box.closest({.7, .8, 0}, 1)->fraction, std::sqrt(.13), 1e-15);
  const auto other = box.closest_on_solid({.7, .1, .2}, 1);
  EXPECT_EQ(box.solid_of(other.simplex), 1);
  EXPECT_NEAR(other.fraction, 1.8, 1e-15);
  std::vector<int> found;
  box.touching({Point<3>(2, -1, -1), Point<3>(4, 1, 1)}, found);
  EXPECT_EQ(static_cast<int>(found.size()), box.n_simplices() / 2);
  EXPECT_TRUE(box.touches({Point<3>(2, -1, -1), Point<3>(4, 1, 1)}));
  EXPECT_FALSE(box.touches({Point<3>(1, -1, -1), Point<3>(2, 1, 1)}));
}

TEST(Closest, ASegment) {
  const auto plate = snapshot<2>({plate_surface<2>({2, 0}, 1, 5)}, false);
  EXPECT_NEAR(plate.closest({0.5, 0.3}, 1)->fraction, 0.3, 1e-15);
  EXPECT_NEAR(plate.closest({4, 4}, 9)->fraction, 5, 1e-14);
  EXPECT_NEAR(plate.closest_on_solid({4, 4}, 0).fraction, 5, 1e-14);
}

TEST(SweptOver, ATranslatingPlate) {
  const auto plate = plate_surface<3>({0, 2, 2}, 0, 0.7);
  const auto before = snapshot<3>({plate}, false);
  const auto after = snapshot<3>({moved<3>(plate, {1, 0, 0})}, false);
  const auto all = all_of(before.n_simplices());
  const auto hit = swept_over(before, after, {.25, .3, .4}, all);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 0.25, 1e-12);
  const auto corners = before.corners(hit->simplex);
  Point<3> x = Point<3>::Zero();
  for (int k = 0; k < 3; ++k)
    x += hit->barycentric[k] * corners[k];
  EXPECT_NEAR((x - Point<3>(0, .3, .4)).norm(), 0, 1e-10);
  EXPECT_FALSE(swept_over(before, after, {.25, 1.01, .4}, all));  // beside it
  EXPECT_FALSE(swept_over(before, after, {1.01, .3, .4}, all));   // ahead of it
  EXPECT_FALSE(swept_over(before, after, {-.01, .3, .4}, all));   // behind it
  EXPECT_FALSE(swept_over(before, after, {0, .3, .4}, all));      // leaves the point
  EXPECT_TRUE(swept_over(before, after, {1, .3, .4}, all));       // arrives at the point
  EXPECT_FALSE(swept_over(before, before, {0, .3, .4}, all));     // rests on the point
  EXPECT_FALSE(swept_over(before, after, {.25, .3, .4}, {}));
}

TEST(SweptOver, ARotatingSegment) {
  // From (0,0)-(1,0) to (0,0)-(0,1): the tip moves along the chord x + y = 1.
  SurfaceMesh<2> hand;
  hand.vertices = {{0, 0}, {1, 0}};
  hand.simplices = {{0, 1}};
  const auto before = snapshot<2>({hand}, false);
  hand.vertices[1] = {0, 1};
  const auto after = snapshot<2>({hand}, false);
  const auto hit = swept_over(before, after, {.3, .3}, {0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->fraction, 0.5, 1e-12);
  EXPECT_NEAR(hit->barycentric[1], 0.6, 1e-10);
  EXPECT_FALSE(swept_over(before, after, {.51, .51}, {0}));
  EXPECT_FALSE(swept_over(before, after, {-.1, .1}, {0}));
}

TEST(SweptOver, EveryPointBetweenTwoBallsOnce) {
  // Points of the moved ball that were outside, and points that the ball left, are swept; points
  // that stay inside, or never were inside, are swept by no net passage.
  const auto ball = ball_surface<3>(1, 0.3);
  const auto before = snapshot<3>({moved<3>(ball, {0, 0, 0}, .1)});
  const auto after = snapshot<3>({moved<3>(ball, {.11, .07, -.05}, .2)});
  const auto all = all_of(before.n_simplices());
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> random(-1.2, 1.2);
  int n_changed = 0;
  for (int i = 0; i < 2000; ++i) {
    const Point<3> x(random(generator), random(generator), random(generator));
    if (before.inside(x) == after.inside(x))
      continue;
    ++n_changed;
    EXPECT_TRUE(swept_over(before, after, x, all)) << x.transpose();
  }
  EXPECT_GT(n_changed, 50);
}

}  // namespace
}  // namespace lockstep::test
