#include <gtest/gtest.h>

#include "mac_cases.hpp"

namespace lockstep::test {
namespace {

GlobalIndex global_count(std::size_t n) {
  return sum_all(world(), static_cast<GlobalIndex>(n));
}

TEST(Geometry, CellsOfABoxAndItsFaces) {
  Case<2> scene({8, 8}, 1.0);
  const auto fluid = scene.make();
  Solids<2> solids;
  solids.add(box_surface<2>(Point<2>(2.4, 3.2), 1.0), Point<2>(4, 4), true);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  // Centres within (2.8, 5.2) x (2.4, 5.6): 2 x 4 cells, or columns 3, 4 and rows 2.5 .. 5.5.
  EXPECT_DOUBLE_EQ(fluid->fluid_volume(), 64 - 8);
  EXPECT_EQ(global_count(fluid->coupled_volumes().size()), 2 * (2 + 4));
  for (const ControlVolume<2>& volume : fluid->coupled_volumes()) {
    const auto& sides = volume.sides;
    EXPECT_NE(sides[0].unknown == no_index, sides[1].unknown == no_index);
    const int inner = sides[0].unknown == no_index ? 0 : 1;
    EXPECT_EQ(sides[inner].kind, SideKind::solid);
    EXPECT_EQ(sides[1 - inner].kind, SideKind::unknown);
    EXPECT_EQ(std::max(sides[0].solid, sides[1].solid), 0);
    EXPECT_NEAR(volume.box.volume(), 1.0, 1e-14);
    EXPECT_TRUE(volume.box.contains(volume.center));
    // The faces across x lie inside the box (3.0 > 2.8), those across y outside (2.0 < 2.4).
    EXPECT_EQ(volume.seen_by_fluid, volume.direction == 1);
  }
}

TEST(Geometry, FacesInsideSolidsAreInactiveAndFeelNoForce) {
  Case<3> scene({16, 16, 16}, 1.0 / 16);
  scene.fluid.set("Density", 1.0);
  scene.fluid.set("Gravity", numbers({0.0, 0.0, -2.0}));
  const auto fluid = scene.make();
  Solids<3> solids;
  solids.add(ball_surface<3>(0.25, 0.05), Point<3>(0.5, 0.5, 0.5), true);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<3>());
  fluid->begin_prediction();
  const auto [impulse, coupled_change] = fluid->add_forces(0.0, 0.5);
  EXPECT_LT((impulse.linear - fluid->audit()->momentum().linear).norm(), 1e-13);
  const auto& faces = fluid->geometry().state.faces[2];
  GlobalIndex free = 0, inactive = 0;
  fluid->domain().grid.for_each_owned_face(2, [&](int cell) {
    free += faces[cell] == FaceState::free;
    inactive += faces[cell] == FaceState::inactive;
    if (faces[cell] == FaceState::inactive) {
      EXPECT_EQ(fluid->prediction()[2][cell], 0);
    }
  });
  EXPECT_GT(sum_all(world(), inactive), 100);
  const double mass = static_cast<double>(sum_all(world(), free)) / (16 * 16 * 16);
  EXPECT_NEAR(impulse.linear[2], -mass, 1e-13);
  for (const double change : coupled_change)
    EXPECT_TRUE(change == -1.0 || change == 0.0);
}

TEST(Geometry, RegionsOfADividedBox) {
  for (const bool divided : {false, true}) {
    Case<2> scene({40, 24}, 0.1);
    const auto fluid = scene.make();
    Solids<2> solids;
    solids.add(ball_surface<2>(0.5, 0.1), Point<2>(1, 1.2), true);
    if (divided)
      solids.add(plate_surface<2>(Point<2>(0, 3), 0, 0.1), Point<2>(2.03, 1.2), false);
    solids.add(box_surface<2>(Point<2>(0.4, 0.4), 0.1), Point<2>(3, 1.2), false);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
    const PressureRegions& regions = fluid->regions();
    // Outside, and the fluid in the hollow box; the plate makes one more. Numbered from the lower
    // left.
    ASSERT_EQ(regions.n_regions, divided ? 3 : 2);
    for (const char fixed : regions.has_dirichlet)
      EXPECT_FALSE(fixed);
    const auto expected = pressure_vector<2>(*fluid, [divided](const Point<2>& x) {
      if ((x - Point<2>(3, 1.2)).lpNorm<Eigen::Infinity>() < 0.2)
        return divided ? 2.0 : 1.0;
      return divided && x[0] > 2.03 ? 1.0 : 0.0;
    });
    const auto values = expected->getData();
    for (std::size_t row = 0; row < regions.of_unknown.size(); ++row)
      ASSERT_EQ(regions.of_unknown[row], static_cast<int>(values[row]));
  }
}

TEST(Geometry, PeriodicSidesJoin) {
  Case<2> scene({20, 20}, 0.05);
  scene.side("x lower", "periodic").side("x upper", "periodic");
  const auto fluid = scene.make();
  Solids<2> solids;
  solids.add(plate_surface<2>(Point<2>(0, 2), 0, 0.05), Point<2>(0.51, 0.5), false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  EXPECT_EQ(fluid->regions().n_regions, 1);
  EXPECT_EQ(global_count(fluid->coupled_volumes().size()), 20);
}

// It is not repeated: faces of the seam lie where it is.
TEST(Geometry, AShellBesideASeamMeetsItsFaces) {
  for (const double x : {0.99, 1.0, 0.0, 0.01}) {
    Case<2> scene({20, 20}, 0.05);
    scene.side("x lower", "periodic").side("x upper", "periodic");
    const auto fluid = scene.make();
    Solids<2> solids;
    solids.add(plate_surface<2>(Point<2>(0, 2), 0, 0.05), Point<2>(x, 0.5), false);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
    EXPECT_EQ(global_count(fluid->coupled_volumes().size()), 20);
    for (const ControlVolume<2>& volume : fluid->coupled_volumes())
      EXPECT_NEAR(volume.center[0], x > 0.5 ? 1 : 0, 1e-14);
  }
}

// One that has left by more than half a cell closes no face, neither there nor a period away.
TEST(Geometry, AShellBeyondASeamMeetsNothing) {
  for (const double x : {-0.03, -0.08, 1.03, 1.08}) {
    Case<2> scene({20, 20}, 0.05);
    scene.side("x lower", "periodic").side("x upper", "periodic");
    const auto fluid = scene.make();
    Solids<2> solids;
    solids.add(plate_surface<2>(Point<2>(0, 2), 0, 0.05), Point<2>(x, 0.5), false);
    fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
    EXPECT_EQ(global_count(fluid->coupled_volumes().size()), 0) << x;
  }
}

TEST(Geometry, AnOpenSideThatAPlateCovers) {
  Case<2> scene({4, 4}, 1.0);
  scene.side("y upper", "open");
  const auto fluid = scene.make();
  Solids<2> solids;
  // Over the two left columns, in the upper half of the last cells.
  solids.add(plate_surface<2>(Point<2>(2, 0), 1, 1.0), Point<2>(1, 3.7), false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  EXPECT_EQ(global_count(fluid->coupled_volumes().size()), 2);
  for (const ControlVolume<2>& volume : fluid->coupled_volumes()) {
    EXPECT_DOUBLE_EQ(volume.center[1], 4.0);
    EXPECT_NEAR(volume.box.volume(), 0.5, 1e-14);
    EXPECT_EQ(volume.sides[1].unknown, no_index);
    EXPECT_EQ(volume.sides[1].kind, SideKind::open);
    EXPECT_FALSE(volume.seen_by_fluid);
  }
}

/// Leaves 0.3 of a face open that is occluded.
struct LeakyFaces : OpenFractionRule<2> {
  double open_fraction(const ControlVolume<2>&, bool occluded,
                       const SurfaceSnapshot<2>&) const override {
    return occluded ? 0.3 : 1;
  }
};

TEST(Geometry, TheFaceTableStoresOnlyWhatIsNotRegular) {
  const double h = 0.5, density = 3;
  Case<2> scene({48, 32}, h);
  scene.fluid.set("Density", density);
  scene.side("x lower", "open").side("x upper", "open");
  const auto fluid = scene.make();
  Solids<2> solids;
  solids.add(plate_surface<2>(Point<2>(20, 0), 1, h), Point<2>(12, 4.2), false);
  fluid->set_geometry(solids.snapshot(), LeakyFaces());
  const MacGeometry<2>& geometry = fluid->geometry();
  const FaceTable<2>& table = geometry.face_table;
  const auto& grid = fluid->domain().grid;
  double open_area = 0, n_partial = 0, leak = 0;
  for (int axis = 0; axis < 2; ++axis) {
    grid.for_each_owned_face(axis, [&](int cell) {
      if (geometry.state.faces[axis][cell] != FaceState::free)
        return;
      const FaceProperties& face = table(axis, cell);
      const double x = grid.face_center(axis, cell)[axis];
      const bool at_side = axis == 0 && (x == 0 || x == 24);
      EXPECT_DOUBLE_EQ(face.distance_factor, at_side ? 2 : 1);
      EXPECT_DOUBLE_EQ(face.mass, density * h * h * face.open / face.distance_factor);
      // Eq. 9: A, the projection and the momentum are of one area and one mass.
      const double area = face.open * table.area();
      EXPECT_DOUBLE_EQ(face.gradient, area / face.mass);
      EXPECT_DOUBLE_EQ(face.coefficient * table.unit_coefficient(), area * area / face.mass);
      n_partial += face.open < 1;
      open_area += face.open;
    });
  }
  // Flow out of a cell through its upper face, perhaps another rank's, enters the next.
  grid.for_each_owned_cell([&](int cell) {
    const int above = grid.neighbor(cell, 1, 1);
    leak += (above < 0 ? 0 : geometry.open_fraction(1, above)) - geometry.open_fraction(1, cell);
  });
  auto n_stored = table.n_stored();
  sum_over_ranks(world(), n_partial, open_area, leak, n_stored);
  EXPECT_EQ(n_partial, 40);
  EXPECT_NEAR(open_area, 49 * 32 + 48 * 31 - 0.7 * 40, 1e-10);
  EXPECT_NEAR(leak, 0, 1e-12);
  EXPECT_GT(n_stored, 0);
  if (world()->getSize() == 1) {
    EXPECT_EQ(n_stored, (2 * 2 + 3) * 16 * 16);  // the tiles of both open sides and of the plate
  }
}

}  // namespace
}  // namespace lockstep::test
