// The viscous solve coupled to solids.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "coupling/viscous_solve.hpp"
#include "support/coupled_case.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

constexpr double viscous_dt = 0.1;

FakeBox<2> viscous_tank(double viscosity) {
  FakeBox<2> box;
  box.n_cells = {8, 4};
  box.spacing = 0.5;
  box.density = 2;
  box.viscosity = viscosity;
  return box;
}

/// A wall across the tank at x = 2: what one side knows of the other, it knows from the solid.
FakeBody<2> partition(typename FakeBody<2>::Kind kind) {
  FakeBody<2> body;
  body.kind = kind;
  body.closed = false;
  body.surface = polyline({{2, 0}, {2, 1}, {2, 2}}, false);
  body.center = {2, 0.6};
  body.mass = 3;
  body.inertia = 0.5;
  return body;
}

ViscousOptions to_round_off() {
  ViscousOptions options;
  options.tolerance = 1e-14;
  return options;
}

ViscousResult<2> solve_viscosity(CoupledCase<2>& c,
                                 const ViscousOptions& options = to_round_off()) {
  const auto system = c.fluid.viscosity()->viscous_system();
  RCP<const LinearOperator> block;
  RCP<const Vector> row;
  if (c.solids.has_unknowns()) {
    block = c.system.blocks(viscous_dt).solid_block();
    row = c.system.lumped_momentum(*c.solids.explicit_momentum(0, viscous_dt));
  }
  return solve_viscous<2>({*system, *c.fluid.viscosity(), c.solids, c.coupling, block, {}},
                          {row, viscous_dt, c.solids.reduction(), options});
}

/// u* = 0 but at the free face of this axis at x.
void kick(CoupledCase<2>& c, int axis, const Point<2>& x) {
  c.fluid.set_velocity(
      [&](int a, const Point<2>& y) { return a == axis && (x - y).norm() < 1e-9 ? 1 : 0; });
}

double velocity_at(const CoupledCase<2>& c, int axis, const Point<2>& x) {
  for (const auto& face : c.fluid.faces()) {
    if (face.volume.direction == axis && (face.volume.center - x).norm() < 1e-9)
      return c.fluid.predicted()[face.volume.id];
  }
  ADD_FAILURE() << "no face there";
  return 0;
}

double swirl(int axis, const Point<2>& x) {
  return axis == 0 ? x.y() * x.y() - x.x() : 3 * x.x() - x.y();
}

}  // namespace

TEST(Viscous, OperatorIsSymmetricThroughTheSolid) {
  for (auto kind : {FakeBody<2>::Kind::rigid, FakeBody<2>::Kind::nodal}) {
    CoupledCase<2> c(viscous_tank(5), fake_solids<2>({{partition(kind)}}));
    // Reciprocity: of equal masses, i answers to j as j to i. The two lie on both sides.
    const Point<2> left(1.5, 0.75), right(3, 1.25);
    kick(c, 0, left);
    solve_viscosity(c);
    const double at_right = velocity_at(c, 0, right);
    kick(c, 0, right);
    solve_viscosity(c);
    const double at_left = velocity_at(c, 0, left);
    EXPECT_GT(std::abs(at_right), 1e-6);
    EXPECT_NEAR(at_left, at_right, 1e-12 * std::abs(at_right) + 1e-14);
  }
}

TEST(Viscous, MomentumHandedOnIsMomentumLost) {
  FakeBody<2> prescribed = partition(FakeBody<2>::Kind::prescribed);
  prescribed.velocity = {1, 2};
  FakeBody<2> block = partition(FakeBody<2>::Kind::rigid);
  block.closed = true;
  block.surface = rectangle({2.9, 0.4}, {3.6, 1.6});  // with faces inside
  block.center = {3.2, 1};
  const std::vector<std::vector<FakeBody<2>>> cases = {{partition(FakeBody<2>::Kind::rigid)},
                                                       {partition(FakeBody<2>::Kind::nodal)},
                                                       {prescribed},
                                                       {block},
                                                       {prescribed, block}};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    SCOPED_TRACE(k);
    CoupledCase<2> c(viscous_tank(0.3), fake_solids<2>({cases[k]}));
    c.fluid.set_velocity(swirl);
    const Momentum<2> before = c.fluid.momentum();
    const ViscousResult<2> result = solve_viscosity(c);
    Momentum<2> defect = c.fluid.momentum() - before - result.boundary_impulse;
    if (c.solids.has_unknowns()) {
      const Momentum<2> handed_on = c.solids.momentum(*result.solid_impulse);
      EXPECT_GT(handed_on.linear.norm(), 1e-3);
      defect += handed_on;
    }
    EXPECT_GT((c.fluid.momentum() - before).linear.norm(), 1e-2);
    EXPECT_LT(defect.linear.norm(), 1e-12);
    EXPECT_LT(defect.angular.norm(), 1e-12);
  }
}

TEST(Viscous, SolidAndFluidMeetAtOneVelocity) {
  // Very viscous: the fluid becomes nearly rigid with the resting, heavy partition.
  FakeBody<2> heavy = partition(FakeBody<2>::Kind::rigid);
  heavy.mass = heavy.inertia = 1e6;
  CoupledCase<2> c(viscous_tank(1e5), fake_solids<2>({{heavy}}));
  c.fluid.set_velocity([](int axis, const Point<2>& x) {
    const bool wall = x.x() == 0 || x.x() == 4;
    return axis == 0 && !wall ? 1 : 0;
  });
  solve_viscosity(c);
  EXPECT_LT(std::abs(velocity_at(c, 0, {1.5, 0.75})), 1e-3);
}

TEST(Viscous, AllSolversByNameGiveOneSolution) {
  const auto inverse = [](const char* type) {
    ParameterList list;
    list.set("Type", std::string(type));
    return list;
  };
  const auto velocity_by = [](const ViscousOptions& options) {
    CoupledCase<2> c(viscous_tank(5), fake_solids<2>({{partition(FakeBody<2>::Kind::nodal)}}));
    c.fluid.set_velocity(swirl);
    solve_viscosity(c, options);
    return velocity_at(c, 0, {1.5, 0.75});
  };
  const double expected = velocity_by(to_round_off());
  for (const char* type : {"Jacobi", "Incomplete Cholesky", "Direct"}) {
    ViscousOptions options;
    options.tolerance = 1e-12;
    options.fluid_inverse = options.solid_inverse = inverse(type);
    EXPECT_NEAR(velocity_by(options), expected, 1e-10 * std::abs(expected)) << type;
  }
}

TEST(Viscous, ToleranceThatIsNotReachedIsAnErrorWithNumbers) {
  CoupledCase<2> c(viscous_tank(5), fake_solids<2>({{partition(FakeBody<2>::Kind::rigid)}}));
  c.fluid.set_velocity(swirl);
  ViscousOptions options;
  options.maximum_iterations = 2;
  try {
    solve_viscosity(c, options);
    ADD_FAILURE();
  } catch (const SolveError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("2 iterations of conjugate gradients"), std::string::npos) << message;
    EXPECT_NE(message.find("asked was 1.0e-10"), std::string::npos) << message;
  }
}

TEST(Viscous, SolidsWithoutMassThatNothingHoldsAreAnError) {
  FakeBody<2> body = partition(FakeBody<2>::Kind::rigid);
  body.mass = -100;
  CoupledCase<2> c(viscous_tank(5), fake_solids<2>({{body}}));
  c.fluid.set_velocity(swirl);
  try {
    solve_viscosity(c);
    ADD_FAILURE();
  } catch (const SolveError& error) {
    EXPECT_NE(std::string(error.what()).find("masses must be positive"), std::string::npos)
        << error.what();
  }
}

TEST(Viscous, VanishingViscosityLeavesEverythingAlone) {
  double last = 0;
  for (double viscosity : {1e-6, 1e-9}) {
    CoupledCase<2> c(viscous_tank(viscosity),
                     fake_solids<2>({{partition(FakeBody<2>::Kind::rigid)}}));
    c.fluid.set_velocity(swirl);
    const double before = velocity_at(c, 0, {1.5, 0.75});
    const double impulse = solve_viscosity(c).solid_impulse->norm2();
    EXPECT_NEAR(velocity_at(c, 0, {1.5, 0.75}), before, 1e3 * viscosity);
    if (last > 0) {
      EXPECT_NEAR(impulse / last, 1e-3, 1e-7);  // proportional
    }
    last = impulse;
  }
  CoupledCase<2> inviscid(viscous_tank(0), fake_solids<2>({{partition(FakeBody<2>::Kind::rigid)}}));
  EXPECT_EQ(inviscid.fluid.viscosity(), nullptr);
}

}  // namespace lockstep::test
