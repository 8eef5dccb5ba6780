// Solids that go round a periodic domain: where snapshots show them, and what is their own place.
#include "coupling/repeated_solids.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"
#include "geometry/solid_volume.hpp"

namespace lockstep::test {
namespace {

constexpr double radius = 0.1, margin = 0.05;

SurfaceMesh<2> disc(double size, const Point<2>& center) {
  SurfaceMesh<2> mesh = ball_surface<2>(size, 0.02);
  for (Point<2>& x : mesh.vertices)
    x += center;
  return mesh;
}

std::vector<SolidDescription> description_of(const SurfaceMesh<2>& mesh) {
  SolidDescription solid;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return {solid};
}

/// The unit square, periodic along x.
RepeatedSolids<2> repeated(const SurfaceMesh<2>& mesh) {
  const Box<2> domain(Point<2>(0, 0), Point<2>(1, 1));
  return {domain, {true, false}, margin, description_of(mesh), mesh, {1}};
}

SurfaceSnapshot<2> shown(RepeatedSolids<2>& solids, SurfaceMesh<2> mesh,
                         const SurfaceSnapshot<2>* before = nullptr) {
  const std::vector<SolidDescription> descriptions = description_of(mesh);
  solids.show(descriptions, before, mesh);
  return {mesh, descriptions, nullptr, solids.images()};
}

TEST(RepeatedSolids, AreWholeInTheDomain) {
  const SurfaceMesh<2> mesh = disc(radius, {3.95, 0.5});
  RepeatedSolids<2> solids = repeated(mesh);
  ASSERT_TRUE(solids.includes(0));
  const SurfaceSnapshot<2> snapshot = shown(solids, mesh);
  EXPECT_EQ(snapshot.n_simplices(), 2 * static_cast<int>(mesh.simplices.size()));
  EXPECT_EQ(snapshot.inside({0.01, 0.5}), 0);
  EXPECT_EQ(snapshot.inside({0.99, 0.5}), 0);
  EXPECT_EQ(snapshot.inside({0.5, 0.5}), -1);
  const Box<2> lower(Point<2>(0, 0), Point<2>(0.5, 1)), upper(Point<2>(0.5, 0), Point<2>(1, 1));
  const double whole = part_of_solid<2>(snapshot, 0, Box<2>(Point<2>(0, 0), Point<2>(2, 1))).volume;
  EXPECT_NEAR(solid_volume_in_box<2>(snapshot, lower) + solid_volume_in_box<2>(snapshot, upper),
              whole, 1e-14);
  EXPECT_NEAR(snapshot.own_bounds(0).center()[0], 0.95, 1e-12);
  EXPECT_LT(snapshot.bounds_of_solid(0).min()[0], -0.1);
}

TEST(RepeatedSolids, KnowTheirOwnPlace) {
  const SurfaceMesh<2> mesh = disc(radius, {3.95, 0.5});
  RepeatedSolids<2> solids = repeated(mesh);
  EXPECT_NEAR(solids.own_place(0, {0.01, 0.5})[0], 4.01, 1e-12);  // before anything was shown
  const SurfaceSnapshot<2> snapshot = shown(solids, mesh);
  EXPECT_NEAR(solids.own_place(0, {0.99, 0.5})[0], 3.99, 1e-12);
  const int n_own = static_cast<int>(mesh.simplices.size());
  for (int s = 0; s < snapshot.n_simplices(); ++s) {
    SurfacePoint<2> point;
    point.simplex = s;
    point.position = snapshot.corners(s)[0];
    const SurfacePoint<2> own = solids.own_point(point);
    EXPECT_EQ(own.simplex, s % n_own);
    EXPECT_NEAR((own.position - mesh.vertices[mesh.simplices[s % n_own][0]]).norm(), 0, 1e-12);
  }
}

/// The first image is at .95, another a period before it.
TEST(RepeatedSolids, AreShownOnceAtEachPlace) {
  const SurfaceMesh<2> mesh = disc(radius, {3.95, 0.5});
  RepeatedSolids<2> solids = repeated(mesh);
  const SurfaceSnapshot<2> snapshot = shown(solids, mesh);
  const int other = static_cast<int>(mesh.simplices.size());
  EXPECT_TRUE(snapshot.is_shown_at(0, {-1, 0}));
  EXPECT_FALSE(snapshot.is_shown_at(0, {1, 0}));
  EXPECT_TRUE(snapshot.is_shown_at(other, {1, 0}));
  EXPECT_FALSE(snapshot.is_shown_at(other, {-1, 0}));
  EXPECT_FALSE(snapshot.is_shown_at(other, {2, 0}));
}

TEST(RepeatedSolids, HaveTheImagesOfAnEarlierSnapshot) {
  const SurfaceMesh<2> at_side = disc(radius, {0.95, 0.5}), beyond = disc(radius, {1.3, 0.5});
  RepeatedSolids<2> solids = repeated(at_side);
  const SurfaceSnapshot<2> before = shown(solids, at_side);
  EXPECT_EQ(shown(solids, beyond).n_simplices(), static_cast<int>(beyond.simplices.size()));
  EXPECT_EQ(shown(solids, beyond, &before).n_simplices(), before.n_simplices());
}

TEST(RepeatedSolids, AreNotTooLong) {
  const SurfaceMesh<2> mesh = disc(0.41, {0.5, 0.5});
  EXPECT_TRUE(repeated(mesh).empty());
  EXPECT_TRUE(RepeatedSolids<2>().empty());
}

}  // namespace
}  // namespace lockstep::test
