// A suite that finds nothing wrong proves nothing: each of these plug-ins breaks one promise.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>

#include "conformance/coupling_conformance.hpp"
#include "conformance/fluid_conformance.hpp"
#include "conformance/solid_conformance.hpp"
#include "geometry/generators.hpp"
#include "support/coupled_case.hpp"

namespace lockstep::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

FakeBox<2> tank() {
  FakeBox<2> box;
  box.n_cells.fill(6);
  box.spacing = 1. / 6;
  box.density = 2;
  box.open_axis = 1;
  box.gravity = {0, -10};
  return box;
}

FakeBody<2> disc() {
  FakeBody<2> body;
  body.surface = ball_surface<2>(0.2, 0.05);
  for (auto& x : body.surface.vertices)
    x += Point<2>(0.53, 0.48);
  body.center = {0.53, 0.48};
  body.velocity = {1, 2};
  body.angular_velocity << 3;
  return body;
}

std::shared_ptr<const SurfaceSnapshot<2>> nothing() {
  return std::make_shared<const SurfaceSnapshot<2>>(SurfaceMesh<2>(),
                                                    std::vector<SolidDescription>());
}

struct WrongProjection : FakeFluid<2> {
  using FakeFluid<2>::FakeFluid;
  void project(const Vector& scaled_pressure) override {
    Vector half(scaled_pressure, Teuchos::Copy);
    half.scale(0.5);
    FakeFluid<2>::project(half);
  }
};
struct WrongImpulse : FakeFluid<2> {
  using FakeFluid<2>::FakeFluid;
  ForceImpulse<2> add_forces(double time, double dt) override {
    ForceImpulse<2> forces = FakeFluid<2>::add_forces(time, dt);
    forces.impulse.linear *= 1.01;
    return forces;
  }
};
struct ForgetfulSides : FakeFluid<2> {
  using FakeFluid<2>::FakeFluid;
  Momentum<2> boundary_pressure_impulse(const Vector&) const override { return {}; }
};

struct ForgetfulFluid : FakeFluid<2> {
  using FakeFluid<2>::FakeFluid;
  void load(const CheckpointReader&) override {}
};
struct FluidThatKeepsAStep : FakeFluid<2> {
  using FakeFluid<2>::FakeFluid;
  ForceImpulse<2> add_forces(double time, double dt) override {
    ForceImpulse<2> forces = FakeFluid<2>::add_forces(time, dt);
    accept();
    return forces;
  }
};

template <typename Fluid>
Violations violations_of_fluid() {
  Fluid fluid(tank(), Tpetra::getDefaultComm());
  fluid.set_velocity([](int axis, const Point<2>& x) { return axis + x.squaredNorm(); });
  return check_fluid<2>(fluid, nothing(), MixedFaceCoupling<2>(MixedFaceOptions{}));
}

TEST(Conformance, FindsFluidsThatBreakAPromise) {
  EXPECT_THAT(violations_of_fluid<FakeFluid<2>>(), ::testing::IsEmpty());
  EXPECT_THAT(violations_of_fluid<WrongProjection>(), Contains(HasSubstr("project:")));
  EXPECT_THAT(violations_of_fluid<WrongImpulse>(), Contains(HasSubstr("add_forces:")));
  EXPECT_THAT(violations_of_fluid<ForgetfulSides>(),
              Contains(HasSubstr("boundary_pressure_impulse:")));
  EXPECT_THAT(violations_of_fluid<ForgetfulFluid>(), Contains(HasSubstr("save, load:")));
  EXPECT_THAT(violations_of_fluid<FluidThatKeepsAStep>(), Contains(HasSubstr("accept:")));
}

struct FastRows : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  void velocity_row(const SurfacePoint<2>& point, const Point<2>& x,
                    VelocityRow<2>& row) const override {
    FakeSolid<2>::velocity_row(point, x, row);
    for (Point<2>& column : row.coefficients)
      column *= 1.01;
  }
};
struct LazyMotion : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  Point<2> effective_velocity(const SurfacePoint<2>&, const Point<2>&) const override {
    return {0, 0};
  }
};
struct LightMomentum : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  std::vector<Momentum<2>> momentum_of_each(const Vector& generalized_momentum) const override {
    auto each = FakeSolid<2>::momentum_of_each(generalized_momentum);
    for (Momentum<2>& momentum : each)
      momentum.linear *= 0.99;
    return each;
  }
};
struct PushingForce : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  RCP<const LinearOperator> implicit_force(double) const override { return mass(); }
};

struct StuckSolid : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  void set_velocity(const Vector&) override {}
};
struct ForgetfulSolid : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  void load(const CheckpointReader&) override {}
};
struct SolidWithoutFile : FakeSolid<2> {
  using FakeSolid<2>::FakeSolid;
  void save(CheckpointWriter&) const override {}
};

template <typename Solid>
Violations violations_of_solid(bool moving) {
  FakeSolidOptions<2> options;
  options.gravity = {0, -10};
  FakeBody<2> body = disc();
  if (!moving) {
    body.velocity.setZero();
    body.angular_velocity.setZero();
  }
  Solid solid({body}, options, Tpetra::getDefaultComm());
  return check_solid<2>(solid);
}

/// Solids at rest are tested, too: the suite sets them in motion.
TEST(Conformance, FindsSolidsThatBreakAPromise) {
  for (const bool moving : {true, false}) {
    EXPECT_THAT(violations_of_solid<FakeSolid<2>>(moving), ::testing::IsEmpty());
    EXPECT_THAT(violations_of_solid<FastRows>(moving), Contains(HasSubstr("velocity_row:")));
    EXPECT_THAT(violations_of_solid<LazyMotion>(moving),
                Contains(HasSubstr("effective_velocity:")));
    EXPECT_THAT(violations_of_solid<LightMomentum>(moving),
                Contains(HasSubstr("momentum_of_each:")));
    EXPECT_THAT(violations_of_solid<PushingForce>(moving),
                Contains(HasSubstr("negative semidefinite")));
    EXPECT_THAT(violations_of_solid<StuckSolid>(moving), Contains(HasSubstr("set_velocity:")));
    EXPECT_THAT(violations_of_solid<ForgetfulSolid>(moving), Contains(HasSubstr("save, load:")));
    EXPECT_THAT(violations_of_solid<SolidWithoutFile>(moving), Contains(HasSubstr("load: ")));
  }
}

struct LeakyVolumes : MixedFaceCoupling<2> {
  using MixedFaceCoupling<2>::MixedFaceCoupling;
  void add_effective_divergence(const SolidSystem<2>& solids, Vector& rhs) const override {
    MixedFaceCoupling<2>::add_effective_divergence(solids, rhs);
    MixedFaceCoupling<2>::add_effective_divergence(solids, rhs);
  }
};
struct HalfTheFluid : MixedFaceCoupling<2> {
  using MixedFaceCoupling<2>::MixedFaceCoupling;
  void add_lumped_momentum(const std::vector<double>& velocity, Vector& rhs) const override {
    std::vector<double> half(velocity);
    for (double& u : half)
      u /= 2;
    MixedFaceCoupling<2>::add_lumped_momentum(half, rhs);
  }
};

template <typename Coupled>
Violations violations_of_coupling() {
  FakeFluid<2> fluid(tank(), Tpetra::getDefaultComm());
  SolidSystem<2> solids(fake_solids<2>({{disc()}}), Tpetra::getDefaultComm());
  Coupled coupling(MixedFaceOptions{});
  return check_coupling<2>(coupling, fluid, solids);
}

TEST(Conformance, FindsCouplingsThatBreakAPromise) {
  EXPECT_THAT(violations_of_coupling<MixedFaceCoupling<2>>(), ::testing::IsEmpty());
  EXPECT_THAT(violations_of_coupling<LeakyVolumes>(),
              Contains(HasSubstr("add_effective_divergence")));
  EXPECT_THAT(violations_of_coupling<HalfTheFluid>(), Contains(HasSubstr("add_lumped_momentum:")));
}

}  // namespace
}  // namespace lockstep::test
