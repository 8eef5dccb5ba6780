// V = P y + b: which dofs are unknowns, by hand and for nodes on rigid bodies.
#include "coupling/reduction.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/triplet_matrix.hpp"
#include "support/coupled_case.hpp"
#include "support/dense.hpp"
#include "support/world.hpp"

namespace lockstep::test {
namespace {

constexpr double round_off = 1e-14;

/// n dofs in equal shares.
RCP<const Map> map_of(GlobalIndex n) {
  return rcp(new Map(n, 0, world()));
}

/// Each rank hands in those of its own dofs.
Reduction reduction_of(const RCP<const Map>& map, const std::vector<Combination>& combinations,
                       const std::vector<GlobalIndex>& given) {
  std::vector<Combination> mine;
  for (const Combination& combination : combinations) {
    if (map->isNodeGlobalElement(combination.dof))
      mine.push_back(combination);
  }
  std::vector<GlobalIndex> mine_given;
  for (const GlobalIndex dof : given) {
    if (map->isNodeGlobalElement(dof))
      mine_given.push_back(dof);
  }
  return Reduction(map, mine, mine_given);
}

std::string failure_of(const std::vector<Combination>& combinations,
                       const std::vector<GlobalIndex>& given) {
  try {
    reduction_of(map_of(6), combinations, given);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

RCP<Vector> vector_of(const std::vector<double>& values, const RCP<const Map>& map) {
  return distributed(Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()), map);
}

RCP<CrsMatrix> matrix_of(const Eigen::MatrixXd& entries, const RCP<const Map>& rows,
                         const RCP<const Map>& columns) {
  std::vector<Triplet> triplets;
  for (GlobalIndex i = 0; i < entries.rows(); ++i) {
    for (GlobalIndex j = 0; j < entries.cols(); ++j) {
      if (rows->isNodeGlobalElement(i))
        triplets.push_back({i, j, entries(i, j)});
    }
  }
  return assemble_triplets(std::move(triplets), rows, columns);
}

/// Some SPD matrix with all its entries.
Eigen::MatrixXd full_block(int n) {
  Eigen::MatrixXd root(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      root(i, j) = std::sin(1 + 3 * i + 7 * j);
  }
  return root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
}

/// V0 = 2 V3 - V5, V1 = V0 + 3 V4 and so 2 V3 - V5 + 3 V4, V2 and V3 given.
const std::vector<Combination> two_levels{{0, {{3, 2}, {5, -1}}}, {1, {{0, 1}, {4, 3}}}};

Eigen::MatrixXd two_levels_by_hand() {
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(6, 6);
  p(0, 5) = p(1, 5) = -1;
  p(1, 4) = 3;
  p(4, 4) = p(5, 5) = 1;
  return p;
}

}  // namespace

TEST(Reduction, WithoutConstraintsNothingIsDone) {
  const RCP<const Map> map = map_of(6);
  const Reduction reduction(map, {}, {});
  EXPECT_TRUE(reduction.is_identity());
  EXPECT_TRUE(reduction.unknowns().is_null());
  EXPECT_TRUE(reduction.with_velocity(vector_of({1, 2, 3, 4, 5, 6}, map)).offset().is_null());
  const auto values = vector_of({1, 2, 3, 4, 5, 6}, map);
  const Vector before(*values, Teuchos::Copy);
  reduction.expand(*values);
  reduction.select(*values);
  reduction.restrict(*values);
  EXPECT_EQ((dense(*values) - dense(before)).norm(), 0);
  const RCP<CrsMatrix> matrix = matrix_of(full_block(6), map, map);
  EXPECT_EQ(reduction.reduce(matrix), matrix);
  EXPECT_EQ(reduction.reduce_rows(matrix), matrix);
  EXPECT_FALSE(reduction.differs_in_unknowns(Reduction()));
}

TEST(Reduction, CombinationsOfCombinationsAndGivenDofs) {
  const RCP<const Map> map = map_of(6);
  const Reduction still = reduction_of(map, two_levels, {2, 3});
  EXPECT_TRUE(still.has_given() && still.has_combinations());
  Eigen::VectorXd expected(6);
  expected << 0, 0, 0, 0, 1, 1;
  EXPECT_EQ((dense(*still.unknowns()) - expected).norm(), 0);
  EXPECT_TRUE(still.differs_in_unknowns(Reduction(map, {}, {})));
  EXPECT_TRUE(still.differs_in_unknowns(reduction_of(map, two_levels, {2})));
  EXPECT_FALSE(still.differs_in_unknowns(reduction_of(map, {{0, {}}, {1, {}}}, {2, 3})));
  EXPECT_EQ(still.combinations_among({5, 1, 4, 0}), (std::vector<GlobalIndex>{0, 1}));

  const auto at_rest = vector_of({9, 9, 9, 9, 4, 5}, map);
  still.expand(*at_rest);
  expected << -5, 12 - 5, 0, 0, 4, 5;
  EXPECT_LT((dense(*at_rest) - expected).norm(), round_off);

  // b of given dofs, and what combinations have beside their terms; V1 has V0's as well.
  const Reduction moving = still.with_velocity(vector_of({0.5, 0.25, 7, 10, 0, 0}, map));
  expected << 20.5, 20.75, 7, 10, 0, 0;
  EXPECT_LT((dense(*moving.offset()) - expected).norm(), round_off);
  const auto velocity = vector_of({9, 9, 9, 9, 4, 5}, map);
  moving.expand(*velocity);
  expected << 15.5, 27.75, 7, 10, 4, 5;
  EXPECT_LT((dense(*velocity) - expected).norm(), round_off);
  const Vector once(*velocity, Teuchos::Copy);
  moving.expand(*velocity);
  EXPECT_LT((dense(*velocity) - dense(once)).norm(), round_off);

  const auto momentum = vector_of({1, 10, 100, 1000, 0.1, 0.2}, map);
  still.restrict(*momentum);
  expected << 0, 0, 0, 0, 30.1, 0.2 - 11;
  EXPECT_LT((dense(*momentum) - expected).norm(), 1e-13);
}

TEST(Reduction, BlocksAreThoseOfTheUnknowns) {
  const RCP<const Map> map = map_of(6), columns = map_of(4);
  const Reduction reduction = reduction_of(map, two_levels, {2, 3});
  const Eigen::MatrixXd block = full_block(6), p = two_levels_by_hand();
  Eigen::MatrixXd expected = p.transpose() * block * p;
  expected.topLeftCorner(4, 4).setIdentity();
  const RCP<const CrsMatrix> reduced_block = reduction.reduce(matrix_of(block, map, map));
  const Eigen::MatrixXd found = dense(reduced_block);
  EXPECT_LT((found - expected).norm(), 1e-13 * expected.norm());
  EXPECT_LT((found - found.transpose()).norm(), 1e-13 * expected.norm());
  EXPECT_GT(found.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 0);
  const Eigen::MatrixXd rows = block.leftCols(4);
  const Eigen::MatrixXd reduced = dense(reduction.reduce_rows(matrix_of(rows, map, columns)));
  EXPECT_LT((reduced - p.transpose() * rows).norm(), 1e-13 * rows.norm());
}

TEST(Reduction, ReactionsDoNoWorkOnUnknowns) {
  const RCP<const Map> map = map_of(6);
  const Reduction reduction = reduction_of(map, two_levels, {2, 3});
  const auto residual = vector_of({1, 10, 100, 1000, 5, 5}, map);
  reduction.keep_reactions(*residual);
  Eigen::VectorXd expected(6);
  expected << 1, 10, 100, 1000, -30, 11;
  EXPECT_LT((dense(*residual) - expected).norm(), 1e-13);
  EXPECT_LT((two_levels_by_hand().transpose() * dense(*residual)).norm(), 1e-13);
}

TEST(Reduction, LongChainsAreResolved) {
  const RCP<const Map> map = map_of(12);
  std::vector<Combination> chain;
  for (GlobalIndex dof = 0; dof < 11; ++dof)
    chain.push_back({dof, {{dof + 1, 2}}});
  const Reduction reduction = reduction_of(map, chain, {});
  const auto velocity = make_vector(map);
  if (map->isNodeGlobalElement(11))
    velocity->replaceGlobalValue(11, 1.);
  reduction.expand(*velocity);
  EXPECT_EQ(dense(*velocity)[0], 2048);
  EXPECT_EQ(dense(*velocity)[10], 2);
}

TEST(Reduction, RefusesWhatHasNoMeaning) {
  EXPECT_THAT(failure_of({{0, {{1, 1}}}, {1, {{2, 1}}}, {2, {{0, 0.5}}}}, {}),
              ::testing::HasSubstr("in a circle"));
  EXPECT_THAT(failure_of({{4, {{4, 0.5}}}}, {}), ::testing::HasSubstr("in a circle"));
  EXPECT_THAT(failure_of({{3, {{1, 1}}}, {3, {{1, 2}}}}, {}),
              ::testing::HasSubstr("Dof 3 of the solids is to follow two motions"));
  EXPECT_THAT(failure_of({{3, {{1, 1}}}}, {3}),
              ::testing::HasSubstr("Dof 3 of the solids is held"));
  // Twice the same is no conflict.
  EXPECT_EQ(failure_of({{3, {{1, 1}, {2, 2}}}, {3, {{2, 2}, {1, 1}}}}, {4, 4}), "");
}

/// A thread whose lower node a turning plate carries.
TEST(Reduction, CarriedNodesTakeNoMomentum) {
  FakeBody<2> plate, thread;
  plate.surface = rectangle({0, 0}, {1, 1});
  plate.center = {0.5, 0.5};
  plate.mass = 3;
  plate.inertia = 0.25;
  thread.kind = FakeBody<2>::Kind::nodal;
  thread.closed = false;
  thread.surface = polyline({{0.75, 1.5}, {2, 2}, {3, 2}}, false);
  const SolidSystem<2> solids(fake_solids<2>({{plate}, {thread}}), world());
  // v = v_c + omega x (x - c) at (0.75, 1.5); the plate's dofs are 0, 1, 2, the node's 3 and 4.
  const std::vector<Combination> node{{3, {{0, 1}, {2, -1}}}, {4, {{1, 1}, {2, 0.25}}}};
  Eigen::VectorXd values = Eigen::VectorXd::Zero(solids.map()->getGlobalNumElements());
  values.head(9) << 0, 0, 0, 3, -7, 0, 0, 0, 0;
  const auto carried = distributed(values, solids.map());
  reduction_of(solids.map(), node, {}).keep_reactions(*carried);
  const Momentum<2> of_carried = solids.momentum(*carried);
  EXPECT_LT(of_carried.linear.norm(), 1e-13);
  EXPECT_LT(of_carried.angular.norm(), 1e-13);
  // The constraint that holds the plate along y acts on it from outside.
  values[1] = 5;
  const auto held = distributed(values, solids.map());
  reduction_of(solids.map(), node, {1}).keep_reactions(*held);
  EXPECT_LT((solids.momentum(*held).linear - Point<2>(0, 5 - 7)).norm(), 1e-13);
}

}  // namespace lockstep::test
