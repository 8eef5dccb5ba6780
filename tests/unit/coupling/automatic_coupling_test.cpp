// Couplings that "automatic" stands for.
#include "coupling/automatic_coupling.hpp"

#include <gtest/gtest.h>

#include "geometry/generators.hpp"

namespace lockstep::test {
namespace {

template <int dim>
CouplingChoice choice(const SurfaceMesh<dim>& mesh, double spacing, bool closed = true,
                      double density = 500, bool rigid = true) {
  SolidDescription solid;
  solid.name = "Body";
  solid.closed = closed;
  solid.rigid = rigid;
  solid.density = density;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return automatic_coupling(SurfaceSnapshot<dim>(mesh, {solid}), spacing, 1000);
}

TEST(AutomaticCoupling, TakesFluxesForThickSolids) {
  EXPECT_EQ(choice(ball_surface<2>(1, 0.1), 0.9).type, "flux");
  EXPECT_EQ(choice(ball_surface<3>(1, 0.1), 0.9).type, "flux");
  EXPECT_EQ(choice(box_surface<3>({2, 2, 2}, 1), 0.9).type, "flux");
  EXPECT_EQ(choice(box_surface<3>({20, 20, 2.2}, 5), 0.9).type, "flux");
}

TEST(AutomaticCoupling, TakesWholeFacesForBodiesWithNextToNoMass) {
  EXPECT_EQ(choice(ball_surface<2>(1, 0.1), 0.5, true, 0.01).reason,
            "\"Body\" is 1e-05 times as dense as the fluid");
}

TEST(AutomaticCoupling, AsksForTwoHundredthsOfTheDensityOfTheFluid) {
  const SurfaceMesh<2> ball = ball_surface<2>(1, 0.1);
  for (const bool rigid : {true, false}) {
    EXPECT_EQ(choice(ball, 0.5, true, 21, rigid).type, "flux");
    EXPECT_EQ(choice(ball, 0.5, true, 2, rigid).reason,
              "\"Body\" is 0.002 times as dense as the fluid");
  }
}

TEST(AutomaticCoupling, TakesWholeFacesForThinSolids) {
  EXPECT_EQ(choice(ball_surface<2>(1, 0.1), 1.1).type, "mixed face");
  const CouplingChoice plate = choice(box_surface<3>({40, 40, 1}, 5), 1.0);
  EXPECT_EQ(plate.type, "mixed face");
  EXPECT_EQ(plate.reason, "\"Body\" is 1 cells thick");
}

/// Two thirds of a cup are hollow: two boxes, one inside the other and turned inside out.
TEST(AutomaticCoupling, IsNotDeceivedByTheExtentOfACup) {
  SurfaceMesh<3> cup = box_surface<3>({10, 10, 10}, 5);
  const SurfaceMesh<3> hollow = box_surface<3>({9, 9, 9}, 5);
  const int first = static_cast<int>(cup.vertices.size());
  cup.vertices.insert(cup.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  for (const auto& [a, b, c] : hollow.simplices)
    cup.simplices.push_back({first + a, first + c, first + b});
  EXPECT_EQ(choice(cup, 0.5).type, "mixed face");
}

TEST(AutomaticCoupling, KnowsNothingOfUnseenBodies) {
  EXPECT_EQ(choice(SurfaceMesh<3>(), 1).reason, "no solid is closed");
}

TEST(AutomaticCoupling, LeavesShellsToWholeFaces) {
  EXPECT_EQ(choice(ball_surface<3>(1, 0.1), 0.1, false).reason, "no solid is closed");
}

}  // namespace
}  // namespace lockstep::test
