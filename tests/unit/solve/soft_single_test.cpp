// Foundations of iterations on a soft solid: its matrix in single precision, and coarse levels.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/matrix_part.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/matrix_sum.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/block_residual.hpp"
#include "solve/preconditioner.hpp"
#include "solve/soft/additive_multilevel.hpp"
#include "solve/soft/aggregation.hpp"
#include "solve/soft/component_cholesky.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/soft/inverse_by_cost.hpp"
#include "solve/soft/multifrontal_cholesky.hpp"
#include "solve/soft/single_precision.hpp"
#include "unit/solve/spring_lattice.hpp"

namespace lockstep::test {

namespace {

/// The nodes without the lone dof.
struct Nodes {
  Nodes(int n, double k) {
    const Lattice solid(n, k);
    std::vector<bool> is_node;
    for (const int body : solid.space.body_of_row)
      is_node.push_back(body >= 0);
    const MatrixPart part(*solid.c, is_node);
    c = part.matrix();
    const auto motions = rcp(new MultiVector(part.map(), 3));
    for (int j = 0; j < 3; ++j)
      part.restrict_to(*solid.space.motions->getVector(j), *motions->getVectorNonConst(j));
    space.motions = motions;
    space.n_bodies = 1;
    space.body_of_row.assign(part.rows().size(), 0);
    space.mass = part.restricted(*solid.space.mass);
  }

  RCP<const CrsMatrix> c;
  NearNullSpace space;
};

}  // namespace

TEST(SoftSolid, SinglePrecisionCopyIsTheMatrixRounded) {
  const Nodes solid(12, 1e3 / 3);
  const auto copy = single_precision_copy(solid.c, solid.space);
  ASSERT_FALSE(copy.is_null());
  EXPECT_LT(symmetry_defect(*copy), 1e-15);
  Vector x(solid.c->getRowMap()), exact(solid.c->getRowMap()), rounded(solid.c->getRowMap());
  pseudo_random(x, 3);
  solid.c->apply(x, exact);
  apply(*copy, x, rounded);
  rounded.update(-1, exact, 1);
  const double error = rounded.norm2() / exact.norm2();
  EXPECT_LT(error, 1e-7);
  EXPECT_GT(error, 1e-10);
}

TEST(SoftSolid, ThereIsNoSinglePrecisionCopyWhereItWouldNotServe) {
  const Lattice with_lone_dof(6, 1);
  EXPECT_TRUE(single_precision_copy(with_lone_dof.c, with_lone_dof.space).is_null());
  const Nodes unknown(6, 1), stiff(6, 1e5);
  EXPECT_TRUE(single_precision_copy(unknown.c, {}).is_null());
  EXPECT_TRUE(single_precision_copy(stiff.c, stiff.space).is_null());
  const auto map = unknown.c->getRowMap();
  std::vector<std::vector<Entry>> diagonal;
  for (const GlobalIndex id : map->getNodeElementList())
    diagonal.push_back({{id, 2}});
  EXPECT_TRUE(single_precision_copy(matrix_from_rows(map, diagonal), unknown.space).is_null());
}

TEST(SoftSolid, IterationOnARoundedMatrixReachesRoundOff) {
  const Nodes solid(24, 1e3 / 3);
  const auto op = as_operator(solid.c);
  const auto jacobi = preconditioner_from_list(op, type("Jacobi"), "solid");
  const auto to = [&](double tolerance, const RCP<const LinearOperator>& rounded) {
    const auto count = std::make_shared<long>(0);
    const auto inverse =
        conjugate_gradient_inverse(op, {jacobi, rounded, tolerance, 5000, "solid", count});
    EXPECT_LT(error_of(*inverse, *solid.c), 2 * tolerance);
    return static_cast<double>(*count);
  };
  // The loss where the residual is replaced is less than the gain of an iteration.
  const auto rounded = single_precision_copy(solid.c, solid.space);
  ASSERT_FALSE(rounded.is_null());
  for (const double tolerance : {1e-2, 1e-5, 1e-9, 1e-13})
    EXPECT_LT(to(tolerance, rounded) / to(tolerance, Teuchos::null), 1.5) << tolerance;
  // Further than round-off lets the true residual fall.
  const auto inverse = conjugate_gradient_inverse(op, {jacobi, rounded, 1e-16, 1000, "solid", {}});
  EXPECT_LT(error_of(*inverse, *solid.c), 1e-13);
}

TEST(SoftSolid, WhatIsRoundedTooMuchIsFinishedWithTheMatrixItself) {
  // At 0.4 C the true residual grows by half with every correction.
  const Nodes solid(12, 10);
  const auto op = as_operator(solid.c);
  const auto far_off = action_operator(solid.c->getRowMap(),
                                       [op](const Vector& x, Vector& y) { apply(*op, x, y, 0.4); });
  const auto jacobi = preconditioner_from_list(op, type("Jacobi"), "solid");
  const auto inverse = conjugate_gradient_inverse(op, {jacobi, far_off, 1e-10, 1000, "solid", {}});
  EXPECT_LT(error_of(*inverse, *solid.c), 1e-9);
}

TEST(SoftSolid, AggregatesAreNodesAndTheirNeighbors) {
  // 9 x 9 nodes with eight neighbours each.
  const Nodes solid(9, 1);
  if (solid.c->getComm()->getSize() > 1)
    GTEST_SKIP() << "Aggregates do not cross ranks.";
  RowsOfNodes nodes{2, {}, {}};
  for (int node = 0; node < 81; ++node) {
    nodes.first.push_back(2 * node);
    nodes.of_row.insert(nodes.of_row.end(), 2, node);
  }
  const Aggregates aggregates = aggregate(*solid.c, nodes);
  std::vector<int> sizes(aggregates.n, 0);
  for (const int a : aggregates.of_node)
    ++sizes.at(a);
  EXPECT_GE(*std::min_element(sizes.begin(), sizes.end()), 3);
  EXPECT_LE(aggregates.n, 81 / 5);
  EXPECT_EQ(aggregates.of_node[0], aggregates.of_node[10]);
  EXPECT_NE(aggregates.of_node[0], aggregates.of_node[80]);
}

TEST(SoftSolid, CoarseMatrixIsThatOfTranslations) {
  // All nodes in one aggregate a rank: only the mass is left, and the springs between ranks.
  const Nodes solid(8, 7);
  const Communicator comm = solid.c->getComm();
  std::vector<int> place;
  for (std::size_t row = 0; row < solid.space.body_of_row.size(); ++row)
    place.push_back(static_cast<int>(row) % 2);
  const auto coarse = coarse_matrix(*solid.c, place, make_map(2, comm));
  Vector ones(coarse->getRowMap()), sums(coarse->getRowMap());
  ones.putScalar(1);
  coarse->apply(ones, sums);
  for (const double sum : sums.getData())
    EXPECT_NEAR(sum, static_cast<double>(place.size()) / 2, 1e-9);
}

TEST(SoftSolid, CoarseLevelsSaveIterations) {
  const Lattice soft(60, 20), stiff(60, 1e3);  // stiffness numbers of 79 and 3900
  EXPECT_LT(iterations(soft, "Additive Multilevel"), 0.65 * iterations(soft, "Jacobi"));
  EXPECT_LT(iterations(stiff, "Additive Multilevel"), 0.4 * iterations(stiff, "Jacobi"));
  // The multigrid of one node alone is the inverse.
  const Lattice one(1, 1);
  const auto inverse =
      preconditioner_from_list(as_operator(one.c), type("Additive Multilevel"), "solid", one.space);
  EXPECT_LT(error_of(*inverse, *one.c), 1e-15);
}

}  // namespace lockstep::test
