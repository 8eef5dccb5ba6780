// The table of null spaces: what pressure levels a coupled system leaves open.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "coupling/null_space.hpp"
#include "linear/matrix_rows.hpp"
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
  const Eigen::MatrixXd a = dense(blocks.pressure_block());
  const Eigen::MatrixXd bt = dense(blocks.coupling_transposed());
  for (std::size_t k = 0; k < blocks.null_space.size(); ++k) {
    const Eigen::VectorXd n = dense(*blocks.null_space.vector(k));
    EXPECT_LT((a * n).norm(), 1e-12);
    EXPECT_LT((bt * n).norm(), 1e-12);
    for (std::size_t l = 0; l <= k; ++l)
      EXPECT_NEAR(n.dot(dense(*blocks.null_space.vector(l))), k == l ? 1 : 0, 1e-12);
  }
  // The kernel of the whole has no more than these.
  const Eigen::MatrixXd block = dense(blocks.solid_block());
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
  const Eigen::VectorXd n = dense(*c.system.null_space().vector(0));
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

/// Orthonormal vectors in the kernel of B^T.
void expect_null_vectors(const NullSpace& vectors, const CrsMatrix& coupling_transposed) {
  Vector product(coupling_transposed.getRangeMap());
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    const RCP<Vector> x = vectors.vector(k);
    coupling_transposed.apply(*x, product);
    EXPECT_LT(product.norm2(), 1e-11);
    for (std::size_t l = 0; l <= k; ++l)
      EXPECT_NEAR(x->dot(*vectors.vector(l)), k == l ? 1 : 0, 1e-12);
  }
}

/// Ten closed regions and an open one, round robin on all ranks, and dofs that compare some of
/// them: 0 + 1 + 2 in many rows, 3 with 4, 5 on its own; the rest none.
TEST(NullSpace, ManyRegionsOnAllRanks) {
  const Communicator comm = Tpetra::getDefaultComm();
  constexpr int n_regions = 11, n_rows = 600;
  const auto pressures = make_map(2 * n_regions, comm), dofs = make_map(n_rows, comm);
  PressureRegions regions;
  regions.n_regions = n_regions;
  regions.has_dirichlet.assign(n_regions, 0);
  regions.has_dirichlet[7] = 1;
  for (int i = 0; i < 2 * n_regions; ++i)
    regions.of_unknown.push_back((i + comm->getRank()) % n_regions);
  // An unknown of region r on any rank, by turns.
  const auto unknown = [&](int region, int turn) {
    const int rank = turn % comm->getSize();
    const int local = (region - rank % n_regions + n_regions) % n_regions;
    return pressures->getGlobalElement(0) + (rank - comm->getRank()) * 2 * n_regions + local;
  };
  std::vector<std::vector<Entry>> rows(n_rows);
  for (int row = 0; row < n_rows; ++row) {
    const double size = 1 + row % 5;
    if (row % 3 == 0)
      rows[row] = {{unknown(0, row), size}, {unknown(1, row / 3), -size}, {unknown(7, row), 2}};
    else if (row % 3 == 1)
      rows[row] = {{unknown(1, row), size}, {unknown(2, row / 3), -size}};
  }
  if (comm->getRank() == comm->getSize() - 1) {
    rows[2] = {{unknown(3, 1), 1}, {unknown(4, 0), -2}};
    rows[5] = {{unknown(5, 0), 1}};
  }
  const RCP<const CrsMatrix> bt = matrix_from_rows(dofs, rows, pressures);
  const NullSpaces found = find_null_spaces(regions, pressures, bt);
  EXPECT_EQ(found.pressure.size(), 10u);
  ASSERT_EQ(found.coupled.size(), 6u);  // {0, 1, 2}, {3, 4}, 6, 8, 9, 10
  expect_null_vectors(found.coupled, *bt);
}

/// Two chains of n regions each, in which every solid compares two neighbours and one solid in the
/// middle of each chain is not there: four levels are left, constant from end to end.
TEST(NullSpace, LongChainsOfRegions) {
  const Communicator comm = Tpetra::getDefaultComm();
  constexpr int n = 150, n_regions = 2 * n;
  const int mine = is_root(comm) ? n_regions : 0;
  const auto pressures = make_map(mine, comm), dofs = make_map(mine, comm);
  PressureRegions regions;
  regions.n_regions = n_regions;
  regions.has_dirichlet.assign(n_regions, 0);
  std::vector<std::vector<Entry>> rows(mine);
  for (int region = 0; region < mine; ++region) {
    regions.of_unknown.push_back(region);
    const bool is_compared = region % n != n / 2 && region % n != n - 1;
    if (is_compared)
      rows[region] = {{region, 1. + region % 7}, {region + 1, -1. - region % 7}};
  }
  const RCP<const CrsMatrix> bt = matrix_from_rows(dofs, rows, pressures);
  const NullSpaces found = find_null_spaces(regions, pressures, bt);
  ASSERT_EQ(found.coupled.size(), 4u);
  expect_null_vectors(found.coupled, *bt);
}

/// More than can be compared is refused on all ranks, in a sentence.
TEST(NullSpace, TooManyRegionsAreRefused) {
  const Communicator comm = Tpetra::getDefaultComm();
  constexpr int n_regions = 5001;
  const int mine = is_root(comm) ? n_regions : 0;
  const auto pressures = make_map(mine, comm), dofs = make_map(mine, comm);
  PressureRegions regions;
  regions.n_regions = n_regions;
  regions.has_dirichlet.assign(n_regions, 0);
  std::vector<std::vector<Entry>> rows(mine);
  for (int region = 0; region < mine; ++region) {
    regions.of_unknown.push_back(region);
    if (region + 1 < mine)
      rows[region] = {{region, 1}, {region + 1, -1}};
  }
  const RCP<const CrsMatrix> bt = matrix_from_rows(dofs, rows, pressures);
  EXPECT_THROW(find_null_spaces(regions, pressures, bt), SolveError);
}

}  // namespace lockstep::test
