// Data of soft bodies for solvers and frames.
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include "output/frames.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using namespace test;

const SurfaceField& field(const SurfaceFrame& frame, const std::string& name) {
  for (const SurfaceField& each : frame.fields) {
    if (each.name == name)
      return each;
  }
  throw std::runtime_error("no field " + name);
}

TEST(Frames, UniformStretchByHand) {
  // F = diag(1.1, 1, 1), E_xx = 0.105; nu = 0: S_xx = 100 E_xx, Cauchy's 1.1 S_xx.
  const auto solids =
      model<3>({box("1, 0.5, 0.5", "0.25") + material("st venant-kirchhoff", "100", "0") +
                number("Density", "2") + numbers("Stretch", "1.1, 1, 1")});
  std::vector<SurfaceFrame> frames;
  solids->add_frames(frames);
  ASSERT_EQ(frames.size(), 1u);
  const SurfaceFrame& frame = frames[0];
  EXPECT_EQ(frame.name, "0 elements");
  EXPECT_EQ(frame.simplex_size, 4);
  const std::size_t n = frame.simplices.size() / 4;
  ASSERT_GT(n, 16u);
  ASSERT_EQ(field(frame, "stress").values.size(), 6 * n);
  for (std::size_t e = 0; e < n; ++e) {
    EXPECT_NEAR(field(frame, "stress").values[6 * e], 1.1 * 10.5, 1e-10);
    EXPECT_NEAR(field(frame, "strain").values[6 * e], 0.105, 1e-12);
    for (int k = 1; k < 6; ++k) {
      EXPECT_NEAR(field(frame, "stress").values[6 * e + k], 0, 1e-10);
      EXPECT_NEAR(field(frame, "strain").values[6 * e + k], 0, 1e-12);
    }
    EXPECT_NEAR(field(frame, "von Mises stress").values[e], 1.1 * 10.5, 1e-10);
    EXPECT_NEAR(field(frame, "energy density").values[e], 0.5 * 10.5 * 0.105, 1e-10);
  }
  double volume = 0;
  for (std::size_t e = 0; e < n; ++e) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
      for (int a = 0; a < 3; ++a)
        edges(a, k) = frame.vertices[3 * frame.simplices[4 * e + k + 1] + a] -
                      frame.vertices[3 * frame.simplices[4 * e] + a];
    }
    volume += edges.determinant() / 6;
  }
  EXPECT_NEAR(volume, 0.25 * 1.1, 1e-12);
}

TEST(RigidMotions, AreWhatImplicitForcesDoNotResist) {
  // At rest, so that no rotation turns a stress.
  const auto solids =
      model<3>({box("1, 0.5, 0.5", "0.25") + material("corotated") + number("Density", "2") +
                    number("Viscosity", "0.1"),
                box("1, 1, 0.5", "0.5") + material("neo-hookean") + number("Density", "2") +
                    numbers("Position", "3, 2, 1") + text("Time Integration", "fully-implicit")});
  const RigidMotions space = solids->near_null_space();
  ASSERT_EQ(space.motions->getNumVectors(), 6u);
  EXPECT_EQ(space.n_bodies, 2);
  EXPECT_EQ(space.n_axes(), 3);
  const auto force = solids->implicit_force(0.1);
  Vector image(solids->dof_map());
  for (int j = 0; j < 6; ++j) {
    EXPECT_GT(space.motions->getVector(j)->norm2(), 1);
    apply(*force, *space.motions->getVector(j), image);
    EXPECT_LT(image.norm2(), 1e-10);
  }
}

TEST(InnerTorque, OnlyTheLinearLawHasOneWhenTurned) {
  const auto turned = [](const std::string& law) {
    const auto solids = model<2>({box("1, 0.5", "0.25") + material(law) + number("Density", "2") +
                                  text("Time Integration", "fully-implicit") +
                                  number("Angular Velocity", "1") + numbers("Stretch", "1.2, 1")});
    solids->move(*solids->velocity(), 0, 0.3);
    return solids->inner_angular_impulse(1.0).norm();
  };
  EXPECT_LT(turned("corotated"), 1e-12);
  EXPECT_LT(turned("neo-hookean"), 1e-12);
  EXPECT_GT(turned("linear"), 0.1);
}

}  // namespace
}  // namespace lockstep::test
