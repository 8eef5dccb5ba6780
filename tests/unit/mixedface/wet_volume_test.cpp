// The liquid that a mixed face lumps where a free surface or a shell parts it from the air.
#include "faces/wet_volume.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"

namespace lockstep::test {
namespace {

/// All below a height.
struct Level : LiquidFluid<2> {
  double height = 0;
  double surface_distance(const Point<2>& x) const override { return x[1] - height; }
  std::vector<WaterLevel> levels_at_solids() const override { return {}; }
  std::vector<double> surface_distances(const std::vector<Point<2>>& points) const override {
    return std::vector<double>(points.size(), 0);
  }
  LiquidReport report() const override { return {}; }
};

/// Cells of width 1; the dual cell of the face across `axis` at (0, 0).
ControlVolume<2> dual_cell(int axis, SideKind lower, SideKind upper) {
  ControlVolume<2> volume;
  volume.direction = axis;
  volume.area = 1;
  volume.box = Box<2>(Point<2>(-0.5, -0.5), Point<2>(0.5, 0.5));
  volume.sides[0] = {lower, 0, -0.5 * Point<2>::Unit(axis), -1};
  volume.sides[1] = {upper, 1, 0.5 * Point<2>::Unit(axis), -1};
  return volume;
}

SurfaceSnapshot<2> plate(int normal, double place) {
  Point<2> size = Point<2>::Constant(4);
  SurfaceMesh<2> mesh = plate_surface<2>(size, normal, 0.3);
  for (auto& x : mesh.vertices)
    x += place * Point<2>::Unit(normal);
  SolidDescription solid;
  solid.closed = false;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return SurfaceSnapshot<2>(mesh, {solid});
}

TEST(WetVolume, OnItsOwnSideOfAHull) {
  Level deep;
  deep.height = 10;
  using Kind = SideKind;
  const auto bottom = plate(1, 0.2);
  EXPECT_NEAR(wet_volume<2>(dual_cell(1, Kind::unknown, Kind::air), bottom, false, deep), 0.7,
              1e-12);
  EXPECT_NEAR(wet_volume<2>(dual_cell(1, Kind::air, Kind::unknown), bottom, false, deep), 0.3,
              1e-12);
  EXPECT_NEAR(wet_volume<2>(dual_cell(1, Kind::unknown, Kind::unknown), bottom, false, deep), 1,
              1e-12);
  EXPECT_NEAR(wet_volume<2>(dual_cell(0, Kind::unknown, Kind::air), plate(0, -0.1), false, deep),
              0.4, 1e-12);
}

TEST(WetVolume, OfAHullAtTheWaterline) {
  Level level;
  level.height = 0.25;  // three quarters of the cell are below
  using Kind = SideKind;
  EXPECT_NEAR(wet_volume<2>(dual_cell(0, Kind::unknown, Kind::air), plate(0, 0.2), false, level),
              0.75 * 0.7, 1e-12);
}

TEST(WetVolume, BesideASolidBelowTheSurface) {
  SurfaceMesh<2> mesh = box_surface<2>(Point<2>(4, 4), 0.3);
  for (auto& x : mesh.vertices)
    x += Point<2>(2.1, 0);  // from x = 0.1 on
  SolidDescription solid;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  const SurfaceSnapshot<2> block(mesh, {solid});
  const auto volume = dual_cell(0, SideKind::unknown, SideKind::solid);
  Level level;
  for (const double height : {-0.6, -0.2, 0.3, 2.0}) {
    level.height = height;
    const double wet = std::min(std::max(height + 0.5, 0.0), 1.0);
    EXPECT_NEAR(wet_volume<2>(volume, block, false, level), 0.6 * wet, 1e-12) << height;
    EXPECT_NEAR(wet_volume<2>(volume, block, true, level), wet, 1e-12) << height;
  }
}

}  // namespace
}  // namespace lockstep::test
