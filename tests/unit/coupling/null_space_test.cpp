// The table of null spaces: what pressure levels a coupled system leaves open.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "support/coupled_case.hpp"
#include "support/dense.hpp"

namespace lockstep::test {
namespace {

FakeBox<2> tank_around(bool open_top, Index<2> n_cells = {6, 6}) {
  FakeBox<2> box;
  box.n_cells = n_cells;
  box.open_axis = open_top ? 1 : -1;
  return box;
}

FakeBody<2> square_body(bool hollow, typename FakeBody<2>::Kind kind) {
  FakeBody<2> body;
  body.kind = kind;
  body.closed = !hollow;
  body.center = {3, 3};
  // Off the cell centres, which lie at halves.
  body.surface = rectangle({1.9, 2.1}, {4.1, 3.9});
  return body;
}

/// Sizes of the coupled null space and of A's, after checking that the coupled vectors are
/// orthonormal and in the kernel of both rows.
std::pair<std::size_t, std::size_t> null_space_sizes(CoupledCase<2>& c) {
  const BlockSystem& blocks = c.system.blocks(0.1);
  const Eigen::MatrixXd a = dense(blocks.pressure_block);
  const Eigen::MatrixXd bt = dense(blocks.coupling_transposed);
  for (std::size_t k = 0; k < blocks.null_space.size(); ++k) {
    const Eigen::VectorXd n = dense(*blocks.null_space[k]);
    EXPECT_LT((a * n).norm(), 1e-12);
    EXPECT_LT((bt * n).norm(), 1e-12);
    for (std::size_t l = 0; l <= k; ++l)
      EXPECT_NEAR(n.dot(dense(*blocks.null_space[l])), k == l ? 1 : 0, 1e-12);
  }
  // The kernel of the whole has no more than these.
  const Eigen::MatrixXd block = dense(blocks.solid_block);
  Eigen::MatrixXd all(a.rows() + block.rows(), a.rows() + block.rows());
  all << a, -bt.transpose(), -bt, -block;
  const Eigen::VectorXd eigenvalues = all.selfadjointView<Eigen::Lower>().eigenvalues();
  EXPECT_EQ(static_cast<std::size_t>((eigenvalues.array().abs() < 1e-11).count()),
            blocks.null_space.size());
  return {blocks.null_space.size(), blocks.pressure_null_space.size()};
}

using Sizes = std::pair<std::size_t, std::size_t>;
using SquareKind = FakeBody<2>::Kind;

}  // namespace

TEST(NullSpace, BallInClosedTankLeavesOneLevel) {
  CoupledCase<2> c(tank_around(false), fake_solids<2>({{square_body(false, SquareKind::rigid)}}));
  EXPECT_EQ(null_space_sizes(c), Sizes(1, 1));
}

TEST(NullSpace, BalloonInClosedTankLeavesOneJointLevel) {
  CoupledCase<2> c(tank_around(false), fake_solids<2>({{square_body(true, SquareKind::nodal)}}));
  EXPECT_EQ(null_space_sizes(c), Sizes(1, 2));
  const Eigen::VectorXd n = dense(*c.system.null_space()[0]);
  EXPECT_LT((n.array() - n[0]).matrix().norm(), 1e-12);  // inside and outside together
}

TEST(NullSpace, BalloonInOpenTankLeavesNone) {
  CoupledCase<2> c(tank_around(true), fake_solids<2>({{square_body(true, SquareKind::nodal)}}));
  EXPECT_EQ(null_space_sizes(c), Sizes(0, 1));
}

TEST(NullSpace, RigidHollowBoxLeavesItsOwnLevel) {
  CoupledCase<2> open(tank_around(true), fake_solids<2>({{square_body(true, SquareKind::rigid)}}));
  EXPECT_EQ(null_space_sizes(open), Sizes(1, 1));
  CoupledCase<2> closed(tank_around(false),
                        fake_solids<2>({{square_body(true, SquareKind::rigid)}}));
  EXPECT_EQ(null_space_sizes(closed), Sizes(2, 2));
}

TEST(NullSpace, PistonBetweenClosedEndsLeavesOneLevel) {
  FakeBody<2> piston;
  piston.closed = false;
  piston.surface = polyline({{3, 0}, {3, 2}}, false);
  piston.center = {3, 1};
  CoupledCase<2> c(tank_around(false, {6, 2}), fake_solids<2>({{piston}}));
  EXPECT_EQ(null_space_sizes(c), Sizes(1, 2));
  // A piston that is held does not compare the two levels.
  piston.locked = {0, 1, 2};
  CoupledCase<2> held(tank_around(false, {6, 2}), fake_solids<2>({{piston}}));
  EXPECT_EQ(null_space_sizes(held), Sizes(2, 2));
}

}  // namespace lockstep::test
