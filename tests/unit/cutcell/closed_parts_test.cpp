// Area and centroid of the part of a face inside a solid.
#include "cutcell/closed_parts.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"

namespace lockstep::test {
namespace {

template <int dim>
SurfaceSnapshot<dim> one_solid(SurfaceMesh<dim> mesh, const Point<dim>& shift, bool closed = true) {
  for (Point<dim>& x : mesh.vertices)
    x += shift;
  SolidDescription solid;
  solid.closed = closed;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return SurfaceSnapshot<dim>(std::move(mesh), {solid});
}

SurfaceSnapshot<3> tetrahedron() {
  SurfaceMesh<3> mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.simplices = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return one_solid<3>(mesh, {0, 0, 0});
}

}  // namespace

TEST(ClosedParts, OfFacesThroughABoxIn2D) {
  // [0.3, 0.8] x [0.2, 0.6]
  const auto surface = one_solid<2>(box_surface<2>({0.5, 0.4}, 0.1), {0.55, 0.4});
  const auto upright = closed_parts<2>(surface, {Point<2>(0.5, 0), Point<2>(0.5, 0.5)}, 0);
  ASSERT_EQ(upright.size(), 1u);
  EXPECT_NEAR(upright[0].area, 0.3, 1e-14);
  EXPECT_NEAR((upright[0].center - Point<2>(0.5, 0.35)).norm(), 0, 1e-14);
  const auto flat = closed_parts<2>(surface, {Point<2>(0.7, 0.3), Point<2>(1, 0.3)}, 1);
  ASSERT_EQ(flat.size(), 1u);
  EXPECT_NEAR(flat[0].area, 0.1, 1e-14);
  EXPECT_NEAR((flat[0].center - Point<2>(0.75, 0.3)).norm(), 0, 1e-14);
  const auto across = closed_parts<2>(surface, {Point<2>(0, 0.5), Point<2>(1, 0.5)}, 1);
  EXPECT_NEAR(across[0].area, 0.5, 1e-14);
  EXPECT_TRUE(closed_parts<2>(surface, {Point<2>(0.9, 0), Point<2>(0.9, 1)}, 0).empty());
}

TEST(ClosedParts, SidesInThePlaneOfAFaceCloseIt) {
  // Both sides, so that a box on the lattice is as wide as its cells.
  const auto surface = one_solid<2>(box_surface<2>({0.5, 0.5}, 0.25), {0.5, 0.5});
  for (const double x : {0.25, 0.75}) {
    const auto parts = closed_parts<2>(surface, {Point<2>(x, 0.5), Point<2>(x, 0.625)}, 0);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(parts[0].area, 0.125, 1e-15);
  }
  const auto box = one_solid<3>(box_surface<3>({0.5, 0.5, 0.5}, 0.25), {0.5, 0.5, 0.5});
  for (const double z : {0.25, 0.75}) {
    const auto parts = closed_parts<3>(box, {Point<3>(0.5, 0.5, z), Point<3>(0.875, 0.625, z)}, 2);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(parts[0].area, 0.25 * 0.125, 1e-15);
    EXPECT_NEAR((parts[0].center - Point<3>(0.625, 0.5625, z)).norm(), 0, 1e-14);
  }
}

TEST(ClosedParts, SectionsOfATetrahedron) {
  const auto surface = tetrahedron();
  for (int axis = 0; axis < 3; ++axis) {
    Box<3> face(Point<3>::Constant(-0.3), Point<3>::Constant(0.9));
    face.min()[axis] = face.max()[axis] = 0.5;
    const auto parts = closed_parts<3>(surface, face, axis);
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_NEAR(parts[0].area, 0.125, 1e-14);
    Point<3> expected = Point<3>::Constant(0.5 / 3);
    expected[axis] = 0.5;
    EXPECT_NEAR((parts[0].center - expected).norm(), 0, 1e-14);
  }
  // The triangle (0, 0) (0.5, 0) (0, 0.5) has only the corner beyond 0.25 in this face.
  const auto corner = closed_parts<3>(surface, {Point<3>(0.25, 0, 0.5), Point<3>(1, 1, 0.5)}, 2);
  EXPECT_NEAR(corner[0].area, 0.25 * 0.25 / 2, 1e-14);
  EXPECT_NEAR((corner[0].center - Point<3>(0.25 + 0.25 / 3, 0.25 / 3, 0.5)).norm(), 0, 1e-14);
}

TEST(ClosedParts, OfTheFacesOfALayerAddUpToItsSection) {
  const auto surface = one_solid<3>(ball_surface<3>(0.4, 0.1), {0.51, 0.48, 0.52});
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto face = [&](double lu, double lv, double width) {
      Box<3> box;
      box.min()[axis] = box.max()[axis] = 0.43;
      box.min()[u] = lu;
      box.max()[u] = lu + width;
      box.min()[v] = lv;
      box.max()[v] = lv + width;
      return box;
    };
    const ClosedPart<3> whole = closed_parts<3>(surface, face(0, 0, 1), axis).front();
    EXPECT_NEAR(whole.area, 3.14 * (0.16 - 0.0081), 0.02);
    double area = 0;
    Point<3> moment = Point<3>::Zero();
    const int n = 16;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (const auto& part :
             closed_parts<3>(surface, face(i / double(n), j / double(n), 1. / n), axis)) {
          area += part.area;
          moment += part.area * part.center;
        }
    EXPECT_NEAR(area, whole.area, 1e-10);
    EXPECT_NEAR((moment / area - whole.center).norm(), 0, 1e-9);
  }
}

TEST(ClosedParts, ShellsCloseNothing) {
  const auto surface = one_solid<2>(box_surface<2>({0.5, 0.4}, 0.1), {0.55, 0.4}, false);
  EXPECT_TRUE(closed_parts<2>(surface, {Point<2>(0.5, 0), Point<2>(0.5, 0.5)}, 0).empty());
}

TEST(ClosedParts, VolumesOfADualCell) {
  // [0.3, 0.8] x [0.2, 0.6]; the dual cell reaches over its left side.
  const auto surface = one_solid<2>(box_surface<2>({0.5, 0.4}, 0.1), {0.55, 0.4});
  const auto parts = closed_volumes<2>(surface, {Point<2>(0.25, 0.5), Point<2>(0.45, 0.7)}, 0);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(parts[0].area, 0.1 * 0.15 / 0.2, 1e-14);
  EXPECT_NEAR(parts[0].center[1], 0.55, 1e-14);
  EXPECT_TRUE(closed_volumes<2>(surface, {Point<2>(0.9, 0), Point<2>(1, 1)}, 0).empty());
}

}  // namespace lockstep::test
