#include <gtest/gtest.h>

#include <cmath>

#include "contact/bodies/carried_point.hpp"
#include "contact/search/continuous_collision.hpp"

namespace lockstep::test {
namespace {

void expect_roots(const std::array<double, 4>& c, const std::vector<double>& expected,
                  double tolerance = 1e-13) {
  const std::vector<double> roots = roots_in_unit_interval(c);
  ASSERT_EQ(roots.size(), expected.size());
  for (std::size_t i = 0; i < roots.size(); ++i)
    EXPECT_NEAR(roots[i], expected[i], tolerance);
}

TEST(CubicRoots, AreFoundInTheUnitInterval) {
  expect_roots({-0.09375, 0.6875, -1.5, 1}, {0.25, 0.5, 0.75});  // (t-1/4)(t-1/2)(t-3/4)
  expect_roots({-0.25, 0.5, 0, 0}, {0.5});
  expect_roots({0.125, -0.75, 1, 0}, {0.25, 0.5});     // (t-1/4)(t-1/2)
  expect_roots({0.25, -0.75, 0, 1}, {0.5}, 1e-7);      // (t-1/2)^2 (t+1): double
  expect_roots({-0.125, 0.75, -1.5, 1}, {0.5}, 1e-4);  // (t-1/2)^3: triple
  expect_roots({0, 0, 0, 1}, {0});                     // at the start
  expect_roots({-1, 1, 0, 0}, {1});                    // at the end
  expect_roots({1, 0, 1, 0}, {});                      // none at all
  expect_roots({2, -1, 0, 0}, {});                     // later
  expect_roots({0, 0, 0, 0}, {});                      // always
  expect_roots({-0.09375e-30, 0.6875e-30, -1.5e-30, 1e-30}, {0.25, 0.5, 0.75});
}

TEST(Impacts, AVertexMeetsATriangle) {
  const PrimitivePoints<3> before{Point<3>(0.25, 0.25, 1), Point<3>(0, 0, 0), Point<3>(1, 0, 0),
                                  Point<3>(0, 1, 0)};
  PrimitivePoints<3> after = before;
  after[0].z() = -3;
  const auto impact = first_impact<3>(PrimitiveKind::vertex_simplex, before, after);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->time, 0.25, 1e-14);
  EXPECT_NEAR((impact->weights - Eigen::Vector4d(1, -0.5, -0.25, -0.25)).norm(), 0, 1e-14);
  EXPECT_NEAR((impact->normal - Point<3>::UnitZ()).norm(), 0, 1e-14);

  after[0] = Point<3>(0.25, 0.25, 0.01);  // stays above
  EXPECT_FALSE(first_impact<3>(PrimitiveKind::vertex_simplex, before, after));
  after[0] = Point<3>(2, 2, -1);  // beside
  EXPECT_FALSE(first_impact<3>(PrimitiveKind::vertex_simplex, before, after));
  // The triangle comes as well: 1 - 4 t = t.
  after = before;
  after[0].z() = -3;
  for (int k = 1; k < 4; ++k)
    after[k].z() = 1;
  EXPECT_NEAR(first_impact<3>(PrimitiveKind::vertex_simplex, before, after)->time, 0.2, 1e-14);
}

TEST(Impacts, TheFirstCrossingOfAPlaneMayBeBesideTheTriangle) {
  // The triangle turns over its edge x = 0 through the vertex' plane twice: corner (2, 0, z) goes
  // down while the vertex passes below it, beside the triangle at first.
  const PrimitivePoints<3> before{Point<3>(3, 0, -1), Point<3>(0, -1, 0), Point<3>(0, 1, 0),
                                  Point<3>(2, 0, 0)};
  PrimitivePoints<3> after = before;
  after[0] = Point<3>(-1, 0, 1);  // z = 0 at t = 1/2, x = 1
  const auto impact = first_impact<3>(PrimitiveKind::vertex_simplex, before, after);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->time, 0.5, 1e-14);
  EXPECT_NEAR((impact->normal + Point<3>::UnitZ()).norm(), 0, 1e-14);
  after[0] = Point<3>(2, 0, 1);  // x = 2.5 there: beside
  EXPECT_FALSE(first_impact<3>(PrimitiveKind::vertex_simplex, before, after));
}

TEST(Impacts, TwoEdgesMeet) {
  const PrimitivePoints<3> before{Point<3>(-1, 0, 1), Point<3>(1, 0, 1), Point<3>(0.5, -1, 0),
                                  Point<3>(0.5, 3, 0)};
  PrimitivePoints<3> after = before;
  after[0].z() = after[1].z() = -1;
  const auto impact = first_impact<3>(PrimitiveKind::edge_edge, before, after);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->time, 0.5, 1e-14);
  EXPECT_NEAR((impact->weights - Eigen::Vector4d(0.25, 0.75, -0.75, -0.25)).norm(), 0, 1e-14);
  EXPECT_NEAR((impact->normal - Point<3>::UnitZ()).norm(), 0, 1e-14);
  PrimitivePoints<3> beside = before, beside_after = after;
  for (int k = 2; k < 4; ++k) {
    beside[k].x() = 1.5;
    beside_after[k].x() = 1.5;
  }
  EXPECT_FALSE(first_impact<3>(PrimitiveKind::edge_edge, beside, beside_after));
}

TEST(Impacts, AVertexMeetsASegment) {
  const PrimitivePoints<2> before{Point<2>(0.25, 1), Point<2>(0, 0), Point<2>(1, 0)};
  PrimitivePoints<2> after = before;
  after[0].y() = -1;
  const auto impact = first_impact<2>(PrimitiveKind::vertex_simplex, before, after);
  ASSERT_TRUE(impact);
  EXPECT_NEAR(impact->time, 0.5, 1e-14);
  EXPECT_NEAR((impact->weights - Eigen::Vector3d(1, -0.75, -0.25)).norm(), 0, 1e-14);
  EXPECT_NEAR((impact->normal - Point<2>::UnitY()).norm(), 0, 1e-14);
}

/// The velocity of a point off a simplex whose corners move rigidly is that of the same motion.
template <int dim>
void expect_rigid_motion(const std::array<Point<dim>, dim>& corners,
                         const AngularVector<dim>& spin) {
  SurfacePoint<dim> point;
  point.barycentric.fill(0.25);
  point.barycentric[0] = 1 - 0.25 * (dim - 1);
  for (int k = 0; k < dim; ++k)
    point.position += point.barycentric[k] * corners[k];
  const Point<dim> x = point.position + Point<dim>::Constant(0.3);
  const auto factors = carried_point<dim>(corners, point, x);
  Point<dim> velocity = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    velocity += factors[k] * rotate<dim>(spin, corners[k]);
  EXPECT_NEAR((velocity - rotate<dim>(spin, x)).norm(), 0, 1e-14);
}

TEST(CarriedPoint, FollowsRigidMotions) {
  expect_rigid_motion<2>({Point<2>(0.2, 0.1), Point<2>(1, 0.7)}, AngularVector<2>(0.7));
  expect_rigid_motion<3>({Point<3>(0.2, 0.1, 0), Point<3>(1, 0.7, 0.3), Point<3>(0, 1, 0.4)},
                         AngularVector<3>(0.7, -0.2, 0.4));
}

/// Above a vertex of two edges, or of four triangles, the corners that take a normal impulse do not
/// hang on which of them the vertex is counted to.
template <int dim>
void expect_impulse_at_vertex(const std::array<Point<dim>, dim>& corners, const Point<dim>& arm) {
  SurfacePoint<dim> vertex;
  vertex.barycentric.fill(0);
  vertex.barycentric[0] = 1;
  vertex.position = corners[0];
  const auto factors = carried_point<dim>(corners, vertex, corners[0] + arm);
  for (int k = 0; k < dim; ++k)
    EXPECT_NEAR((factors[k].transpose() * arm - (k == 0 ? 1 : 0) * arm).norm(), 0, 1e-15) << k;
}

TEST(CarriedPoint, TakesAnImpulseAlongTheRodAlone) {
  expect_impulse_at_vertex<2>({Point<2>(0, 0), Point<2>(1, -0.2)}, {0, 0.1});
  expect_impulse_at_vertex<2>({Point<2>(0, 0), Point<2>(-1, -0.2)}, {0, 0.1});
  expect_impulse_at_vertex<3>({Point<3>(0, 0, 0), Point<3>(1, 0, -0.2), Point<3>(0, 1, -0.2)},
                              {0, 0.02, 0.1});
}

}  // namespace
}  // namespace lockstep::test
