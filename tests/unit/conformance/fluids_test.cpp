// The fluid and the couplings that come with Lockstep keep the promises of their interfaces.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "conformance/coupling_conformance.hpp"
#include "conformance/fluid_conformance.hpp"
#include "cutcell/flux_coupling.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "support/coupled_case.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {
namespace {

using ::testing::IsEmpty;

template <int dim>
std::unique_ptr<MacFluid<dim>> moving_fluid(double viscosity, bool open) {
  Case<dim> scene(cube<dim>(dim == 2 ? 20 : 10), dim == 2 ? 0.05 : 0.1);
  scene.fluid.set("Density", 3.0);
  scene.fluid.set("Viscosity", viscosity);
  scene.fluid.set("Gravity", dim == 2 ? numbers({0.3, -2}) : numbers({0.3, 0, -2}));
  scene.fluid.set("Velocity", dim == 2 ? numbers({0.3, 0.2}) : numbers({0.3, 0.2, -0.1}));
  if (open)
    scene.side(dim == 2 ? "y upper" : "z upper", "open");
  return scene.make();
}

template <int dim>
FakeBody<dim> ball(double x) {
  FakeBody<dim> body;
  body.name = "ball at " + std::to_string(x);
  body.center = Point<dim>::Constant(x);
  body.surface = ball_surface<dim>(0.17, dim == 2 ? 0.03 : 0.1);
  for (auto& vertex : body.surface.vertices)
    vertex += body.center;
  body.velocity[0] = 1;
  return body;
}

template <int dim>
void expect_promises_kept() {
  const auto nothing = std::make_shared<const SurfaceSnapshot<dim>>(
      SurfaceMesh<dim>(), std::vector<SolidDescription>());
  const FakeSolid<dim> solid({ball<dim>(0.53)}, {}, Tpetra::getDefaultComm());
  const auto surface =
      std::make_shared<const SurfaceSnapshot<dim>>(solid.surface(), solid.solids());
  for (const bool open : {false, true}) {
    for (const double viscosity : {0.0, 0.1}) {
      const auto fluid = moving_fluid<dim>(viscosity, open);
      const MixedFaceCoupling<dim> mixed(MixedFaceOptions{});
      const FluxCoupling<dim> flux(FluxOptions{});
      EXPECT_THAT(check_fluid<dim>(*fluid, nothing, mixed), IsEmpty());
      EXPECT_THAT(check_fluid<dim>(*fluid, surface, mixed), IsEmpty());
      EXPECT_THAT(check_fluid<dim>(*fluid, surface, flux), IsEmpty());
    }
  }
}

TEST(Conformance, TheStaggeredGrid2D) {
  expect_promises_kept<2>();
}
TEST(Conformance, TheStaggeredGrid3D) {
  expect_promises_kept<3>();
}

template <int dim>
void expect_couplings_to_keep_theirs() {
  FakeBody<dim> prescribed = ball<dim>(0.8);
  prescribed.kind = FakeBody<dim>::Kind::prescribed;
  FakeBody<dim> soft = ball<dim>(0.33);
  soft.kind = FakeBody<dim>::Kind::nodal;
  for (const auto& [body, with_prescribed] :
       {std::pair{ball<dim>(0.33), false}, std::pair{ball<dim>(0.33), true}, std::pair{soft, false},
        std::pair{soft, true}}) {
    std::vector<FakeBody<dim>> bodies{body};
    if (with_prescribed)
      bodies.push_back(prescribed);
    SolidSystem<dim> solids(fake_solids<dim>({bodies}), Tpetra::getDefaultComm());
    const auto fluid = moving_fluid<dim>(0, true);
    MixedFaceCoupling<dim> mixed(MixedFaceOptions{});
    FluxCoupling<dim> flux(FluxOptions{});
    EXPECT_THAT(check_coupling<dim>(mixed, *fluid, solids), IsEmpty());
    EXPECT_THAT(check_coupling<dim>(flux, *fluid, solids), IsEmpty());
  }
}

TEST(Conformance, MixedFacesAndFlux2D) {
  expect_couplings_to_keep_theirs<2>();
}
TEST(Conformance, MixedFacesAndFlux3D) {
  expect_couplings_to_keep_theirs<3>();
}

}  // namespace
}  // namespace lockstep::test
