// Eq. 16 on 4 x 3 cells, every entry by hand.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <functional>

#include "support/coupled_case.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

constexpr double near = 1e-13;

/// 4 x 3 cells of h = 1/2 and density 2, cell c = i + 4 j. One face is mixed, x = (1, 0.75)
/// between cells 5 and 6: its lower half follows a rigid plate that turns about (1, 0.5), its upper
/// half a prescribed plate that moves with 6 m/s.
FakeBox<2> two_plate_box(bool open_top) {
  FakeBox<2> box;
  box.n_cells = {4, 3};
  box.spacing = 0.5;
  box.density = 2;
  box.open_axis = open_top ? 1 : -1;
  return box;
}

Models<2> plates(const std::vector<int>& locked, const FakeSolidOptions<2>& options = {}) {
  FakeBody<2> plate;
  plate.closed = false;
  plate.surface = polyline({{1, 0.5}, {1, 0.75}}, false);
  plate.center = {1, 0.5};
  plate.mass = 3;
  plate.inertia = 0.7;
  plate.velocity = {1, 2};
  plate.angular_velocity[0] = 4;
  plate.locked = locked;
  FakeBody<2> moved;
  moved.kind = FakeBody<2>::Kind::prescribed;
  moved.closed = false;
  moved.surface = polyline({{1, 0.75}, {1, 1}}, false);
  moved.velocity = {6, 0};
  return fake_solids<2>({{plate, moved}}, options);
}

/// u* = x + 10 y, v* = x y.
double sheared(int axis, const Point<2>& x) {
  return axis == 0 ? x.x() + 10 * x.y() : x.x() * x.y();
}

Eigen::MatrixXd pressure_block_by_hand(bool open_top) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(12, 12);
  const auto link = [&](int c, int d) {  // V / (rho h^2) = 1/rho
    a(c, c) += 0.5;
    a(d, d) += 0.5;
    a(c, d) -= 0.5;
    a(d, c) -= 0.5;
  };
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 4; ++i) {
      if (i < 3 && !(i == 1 && j == 1))
        link(i + 4 * j, i + 1 + 4 * j);
      if (j < 2)
        link(i + 4 * j, i + 4 * j + 4);
    }
  }
  for (int i = 0; i < 4 && open_top; ++i)
    a(8 + i, 8 + i) += 1;  // p = 0 at h/2
  return a;
}

}  // namespace

TEST(Eq16, PressureBlockByHand) {
  for (bool open_top : {false, true}) {
    CoupledCase<2> c(two_plate_box(open_top), plates({}));
    const Eigen::MatrixXd a = dense(c.system.blocks(0.1).pressure_block());
    EXPECT_LT((a - pressure_block_by_hand(open_top)).norm(), near);
    const Eigen::VectorXd eigenvalues = a.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_EQ((eigenvalues.array() < 1e-12).count(), open_top ? 0 : 1);
    EXPECT_EQ(c.system.null_space().size(), open_top ? 0 : 1);
  }
}

TEST(Eq16, CouplingBlockByHand) {
  CoupledCase<2> c(two_plate_box(true), plates({}));
  // W = 1/2 (1, 0, -(0.75 - 0.5)); B^T = W^T A (-1 on the lower cell, 1 on the upper), A = h.
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 12);
  expected(0, 5) = -0.25;
  expected(0, 6) = 0.25;
  expected(2, 5) = 0.0625;
  expected(2, 6) = -0.0625;
  const Eigen::MatrixXd bt = dense(c.system.blocks(0.1).coupling_transposed());
  EXPECT_LT((bt.topRows(3) - expected).norm(), near);
  EXPECT_EQ(bt.bottomRows(bt.rows() - 3).norm(), 0);  // padding
}

TEST(Eq16, AddedMassByHand) {
  const double fluid = 2 * 0.25;  // rho h^2 [kg]
  const Eigen::Vector3d row(1, 0, -0.25);
  for (Lumping lumping : {Lumping::diagonal, Lumping::consistent}) {
    MixedFaceOptions options;
    options.lumping = lumping;
    FakeSolidOptions<2> damped;
    damped.damping = 5;
    CoupledCase<2> c(two_plate_box(true), plates({}, damped), options);
    // Diagonal lumping gives the plate its half of the fluid, consistent lumping weighs it twice.
    const double share = lumping == Lumping::diagonal ? 0.5 : 0.25;
    const Eigen::Matrix3d added = share * fluid * row * row.transpose();
    EXPECT_LT((dense(c.coupling.added_mass()).topLeftCorner(3, 3) - added).norm(), near);
    const double dt = 0.1;
    Eigen::Matrix3d expected = added + dt * 5 * Eigen::Matrix3d::Identity();
    expected.diagonal() += Eigen::Vector3d(3, 3, 0.7);
    const Eigen::MatrixXd block = dense(c.system.blocks(dt).solid_block());
    EXPECT_LT((block.topLeftCorner(3, 3) - expected).norm(), near);
    EXPECT_LT((block - block.transpose()).norm(), near);
    EXPECT_EQ(block.llt().info(), Eigen::Success);
    const int n_padding = static_cast<int>(block.rows()) - 3;
    EXPECT_LT((block.bottomRightCorner(n_padding, n_padding) -
               Eigen::MatrixXd::Identity(n_padding, n_padding))
                  .norm(),
              near);
  }
}

/// C = M~ - dt D is kept while neither dt nor D changes, and made anew after all that changes D.
TEST(Eq16, SolidBlockFollowsTheLinearisation) {
  FakeSolidOptions<2> damped;
  damped.damping = 5;
  CoupledCase<2> c(two_plate_box(true), plates({}, damped));
  const auto version = [&c](double dt) { return c.system.blocks(dt).solids.version; };
  const long first = version(0.5);
  EXPECT_EQ(version(0.5), first);
  EXPECT_NE(version(0.25), first);
  for (const auto& change :
       std::vector<std::function<void()>>{[&c] { c.solids.linearise(0.5, *c.solids.velocity()); },
                                          [&c] { c.solids.set_velocity(*c.solids.velocity()); },
                                          [&c] { c.solids.move(*c.solids.velocity(), 0, 0.5); },
                                          [&c] { c.solids.begin_step(0, 0.5); }}) {
    const long before = version(0.5);
    EXPECT_EQ(version(0.5), before);
    change();
    EXPECT_NE(version(0.5), before);
  }
}

TEST(Eq16, RightHandSidesByHand) {
  for (Lumping lumping : {Lumping::diagonal, Lumping::consistent}) {
    MixedFaceOptions options;
    options.lumping = lumping;
    CoupledCase<2> c(two_plate_box(true), plates({}), options);
    c.fluid.set_velocity(sheared);
    double removed = -1;
    const BlockVector rhs = c.system.right_hand_side(*c.solids.explicit_momentum(0, 0.1), removed);
    EXPECT_EQ(removed, 0);
    const Eigen::VectorXd pressure = dense(*rhs.pressure);
    // Minus the outflow. Cell 0 lies in a corner whose walls move with 2.5 and 0 m/s.
    EXPECT_NEAR(pressure[0], 0.5 * (2.5 - 3 + 0 - 0.125), near);
    // The mixed face counts with the prescribed half, 3 m/s: it leaves cell 5 and enters cell 6.
    EXPECT_NEAR(pressure[5], 0.5 * (8 + 0.375 - 0.75 - 3), near);
    EXPECT_NEAR(pressure[6], 0.5 * (-9 + 0.625 - 1.25 + 3), near);
    // M_S V_S* + W^T M_F (u*_F - W_k V_k), u*_F = 8.5; diagonally lumped fluid keeps W_k V_k out.
    const double momentum = 0.5 * (lumping == Lumping::diagonal ? 8.5 : 8.5 - 3);
    const Eigen::VectorXd solid = dense(*rhs.solid);
    EXPECT_NEAR(solid[0], 3 + 0.5 * momentum, near);
    EXPECT_NEAR(solid[1], 6, near);
    EXPECT_NEAR(solid[2], 2.8 - 0.125 * momentum, near);
    // Handed back: W V_S + W_k V_k.
    const auto back = c.coupling.velocity(*c.solids.velocity());
    const double sum = sum_all(c.solids.comm(), back.empty() ? 0. : back[0]);
    EXPECT_NEAR(sum, 0.5 * 1 - 0.125 * 4 + 3, near);
  }
}

TEST(Eq16, ClosedTankProjectsTheRightHandSide) {
  CoupledCase<2> c(two_plate_box(false), plates({}));
  c.fluid.set_velocity([](int axis, const Point<2>& x) { return axis == 0 ? x.x() : 0; });
  double removed = 0;
  const BlockVector rhs = c.system.right_hand_side(*c.solids.explicit_momentum(0, 0.1), removed);
  EXPECT_NEAR(dense(*rhs.pressure).sum(), 0, near);
  EXPECT_GT(removed, 0.3);  // the right wall draws off 2 * 1.5 m^2/s that nothing replaces
}

TEST(Eq16, LockedDofsAreEliminatedAndTheirReactionsFound) {
  CoupledCase<2> c(two_plate_box(true), plates({0, 1}));
  c.fluid.set_velocity(sheared);
  const double dt = 0.1, inertia = 0.7 + 0.5 * 0.5 * 0.0625;
  const BlockSystem& blocks = c.system.blocks(dt);
  const Eigen::MatrixXd block = dense(blocks.solid_block());
  EXPECT_LT(
      (block.topLeftCorner(3, 3) - Eigen::Matrix3d(Eigen::Vector3d(1, 1, inertia).asDiagonal()))
          .norm(),
      near);
  const Eigen::MatrixXd bt = dense(blocks.coupling_transposed());
  EXPECT_EQ(bt.topRows(2).norm(), 0);
  EXPECT_NEAR(bt(2, 5), 0.0625, near);
  double removed = 0;
  const RCP<Vector> momentum = c.solids.explicit_momentum(0, dt);
  const BlockVector rhs = c.system.right_hand_side(*momentum, removed);
  EXPECT_EQ(dense(*rhs.solid).head(2).norm(), 0);

  // Row 2 with the locked rows back: reaction = C V + B^T p̂ - rhs, here for omega = 2, p̂_5 = 8.
  Eigen::VectorXd turning = Eigen::VectorXd::Zero(block.rows());
  turning[2] = 2;
  const BlockVector solution{distributed(8 * Eigen::VectorXd::Unit(12, 5), rhs.pressure->getMap()),
                             distributed(turning, c.solids.map())};
  const Eigen::VectorXd reaction =
      dense(*c.system.reactions(dt, c.solids.reduction(), *momentum, solution));
  EXPECT_NEAR(reaction[0], 2 * 0.25 * -0.25 - 0.25 * 8 - (3 + 0.5 * 0.5 * 8.5), near);
  EXPECT_NEAR(reaction[1], -6, near);
  EXPECT_EQ(reaction[2], 0);
}

TEST(Eq16, LockedDofsThatMoveActOnTheOthers) {
  CoupledCase<2> c(two_plate_box(true), plates({0, 1}));
  c.fluid.set_velocity(sheared);
  const double dt = 0.1;
  const RCP<Vector> momentum = c.solids.explicit_momentum(0, dt);
  Eigen::VectorXd moving = Eigen::VectorXd::Zero(dense(*momentum).size());
  moving.head(2) << 3, -2;
  const Reduction constraints =
      c.solids.reduction().with_velocity(distributed(moving, c.solids.map()));
  double removed = 0;
  const BlockVector still = c.system.right_hand_side(*momentum, removed);
  const BlockVector rhs = c.system.right_hand_side(*momentum, dt, constraints, removed);
  // The blocks with nothing locked say what the velocities do to the two rows.
  CoupledCase<2> loose(two_plate_box(true), plates({}));
  const BlockSystem& blocks = loose.system.blocks(dt);
  const Eigen::VectorXd flux = dense(blocks.coupling_transposed()).transpose() * moving;
  EXPECT_GT(flux.norm(), 0.1);
  EXPECT_LT((dense(*rhs.pressure) - dense(*still.pressure) - flux).norm(), near);
  const Eigen::VectorXd push = dense(*rhs.solid) - dense(*still.solid);
  EXPECT_EQ(push.head(2).norm(), 0);
  const Eigen::VectorXd inertia = dense(blocks.solid_block()) * moving;
  EXPECT_LT((push + inertia).tail(push.size() - 2).norm(), near);
}

// A5, Fig. 4: a dual cell filled half by fluid (density rho1) and half by a solid (rho2). Solid and
// lumped fluid accelerate together; what the fluid half needs tells the pressure between the two.
TEST(Eq16, PressureInsideAHalfFilledDualCell) {
  const double rho1 = 3, rho2 = 7, h = 0.5;
  FakeBox<2> channel;
  channel.n_cells = {4, 1};
  channel.spacing = h;
  channel.density = rho1;
  FakeBody<2> body;
  // The upper half of the dual cell at x = 2 h, short of the next cell's centre by a hair.
  body.surface = rectangle({2 * h, 0}, {2.5 * h - 1e-11, h});
  body.center = {2.25 * h, h / 2};
  body.mass = rho2 * h * h / 2;
  CoupledCase<2> c(channel, fake_solids<2>({{body}}));
  const Eigen::MatrixXd bt = dense(c.system.blocks(1).coupling_transposed());
  const Eigen::MatrixXd block = dense(c.system.blocks(1).solid_block());
  const Eigen::Vector4d p(0, 11, 2, 0);  // p̂ of the cells; the mixed face lies between 1 and 2
  const Eigen::VectorXd impulse = -bt * p;
  EXPECT_NEAR(impulse[0], h * (11 - 2), near);
  const Eigen::VectorXd velocity_change = block.llt().solve(impulse);
  const auto& masses = c.coupling.fluid_mass();
  const double fluid_mass = sum_all(c.solids.comm(), masses.empty() ? 0. : masses[0]);
  const double between = p[1] - fluid_mass * velocity_change[0] / h;
  EXPECT_NEAR(between, (rho2 * p[1] + rho1 * p[2]) / (rho1 + rho2), 1e-8);
}

}  // namespace lockstep::test
