// Eq. 16 as a Thyra operator, as a merged matrix, and its exact inverses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Thyra_PhysicallyBlockedLinearOpBase.hpp>
#include <Thyra_VectorStdOps.hpp>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "linear/block_diagonal.hpp"
#include "solve/added_mass_diagonal.hpp"
#include "solve/block_residual.hpp"
#include "solve/gathered_direct.hpp"
#include "solve/merge.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/thyra_vectors.hpp"
#include "support/world.hpp"

namespace lockstep::test {

namespace {

BlockVector random_vector(const SaddleProblem& problem, int seed) {
  BlockVector x = problem.zero();
  pseudo_random(*x.pressure, seed);
  pseudo_random(*x.solid, seed + 100);
  return x;
}

/// A tridiagonal matrix (-1, 2, -1) with `n` rows, dealt out evenly.
RCP<CrsMatrix> tridiagonal(int n) {
  const int size = world()->getSize(), rank = world()->getRank();
  const auto map = make_map((rank + 1) * n / size - rank * n / size, world());
  std::vector<std::vector<Entry>> rows(map->getNodeNumElements());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const GlobalIndex id = map->getGlobalElement(static_cast<int>(row));
    for (GlobalIndex column = std::max<GlobalIndex>(0, id - 1);
         column <= std::min<GlobalIndex>(n - 1, id + 1); ++column) {
      rows[row].push_back({column, column == id ? 2.0 : -1.0});
    }
  }
  return matrix_from_rows(map, rows);
}

/// |op inverse x - x| / |x|
double inverse_error(const LinearOperator& op, const LinearOperator& inverse) {
  Vector x(domain_map(op)), y(x.getMap()), z(x.getMap());
  pseudo_random(x, 5);
  apply(inverse, x, y);
  apply(op, y, z);
  return relative_difference(x, z);
}

}  // namespace

TEST(BlockOperator, MatchesTheHandMultiplication) {
  // [2 -1 | -1; -1 2 | 0; -1 0 | -4] (1, 2, 3) = (-3, 3, -13), all on rank 0.
  const bool root = is_root(world());
  const auto cells = make_map(root ? 2 : 0, world()), dofs = make_map(root ? 1 : 0, world());
  std::vector<std::vector<Entry>> a, b, c;
  if (root) {
    a = {{{0, 2}, {1, -1}}, {{0, -1}, {1, 2}}};
    b = {{{0, 1}}};
    c = {{{0, 4}}};
  }
  BlockSystem system;
  system.set_blocks(as_operator(matrix_from_rows(cells, a)), matrix_from_rows(dofs, b, cells),
                    as_operator(matrix_from_rows(dofs, c)));
  const BlockVector x{make_vector(cells), make_vector(dofs)},
      y{make_vector(cells), make_vector(dofs)};
  if (root) {
    x.pressure->replaceLocalValue(0, 1.0);
    x.pressure->replaceLocalValue(1, 2.0);
    x.solid->replaceLocalValue(0, 3.0);
  }
  const auto op = system.op();
  op->apply(Thyra::NOTRANS, *as_thyra(x, *op), as_thyra(y, *op).ptr(), 1, 0);
  if (root) {
    EXPECT_DOUBLE_EQ(y.pressure->getData()[0], -3);
    EXPECT_DOUBLE_EQ(y.pressure->getData()[1], 3);
    EXPECT_DOUBLE_EQ(y.solid->getData()[0], -13);
  }
}

TEST(BlockGroup, ItsBlocksAreNamedWithTheirParts) {
  BlockGroup group{{{"bodies", 0, 3}, {"cloth", 3, 4}}};
  Vector residual(make_map(4, world()));
  residual.putScalar(2 / std::sqrt(3. * world()->getSize()));
  EXPECT_EQ(by_name(group, residual, 4),
            fmt::format(" (bodies {:.2e}, cloth {:.2e})", 0.5, 0.5 / std::sqrt(3.)));
  group.blocks.pop_back();
  EXPECT_EQ(by_name(group, residual, 4), "");
}

TEST(BlockOperator, IsSymmetricAndEqualsTheMergedMatrix) {
  const SaddleProblem problem(world(), {});
  const auto op = problem.system.op();
  const BlockVector u = random_vector(problem, 1), v = random_vector(problem, 2),
                    ku = problem.zero(), kv = problem.zero();
  op->apply(Thyra::NOTRANS, *as_thyra(u, *op), as_thyra(ku, *op).ptr(), 1, 0);
  op->apply(Thyra::NOTRANS, *as_thyra(v, *op), as_thyra(kv, *op).ptr(), 1, 0);
  const double uv = u.pressure->dot(*kv.pressure) + u.solid->dot(*kv.solid);
  const double vu = v.pressure->dot(*ku.pressure) + v.solid->dot(*ku.solid);
  EXPECT_NEAR(uv, vu, 1e-12 * kv.solid->norm2() * u.solid->norm2());

  const MergedSystem merged = merge(problem.system);
  Vector product(merged.matrix->getRowMap());
  merged.matrix->apply(*to_merged(merged, u), product);
  BlockVector from_matrix = problem.zero();
  from_merged(merged, product, from_matrix);
  EXPECT_LT(relative_difference(*ku.pressure, *from_matrix.pressure), 1e-13);
  EXPECT_LT(relative_difference(*ku.solid, *from_matrix.solid), 1e-13);
}

TEST(MergedSystem, BorderMakesAClosedTankRegular) {
  SaddleOptions options;
  options.open_top = false;
  const SaddleProblem problem(world(), options);
  const MergedSystem merged = merge(problem.system);
  EXPECT_EQ(merged.matrix->getGlobalNumRows(), 16u * 16u + 6u + 1u);
  const auto inverse = gathered_direct(merged.matrix, "closed tank");
  EXPECT_LT(inverse_error(*as_operator(merged.matrix), *inverse), 1e-9);
}

TEST(GatheredDirect, IsRightOnAnyNumberOfRanks) {
  const auto matrix = tridiagonal(8);
  EXPECT_LT(inverse_error(*as_operator(matrix), *gathered_direct(matrix, "test")), 1e-14);
}

TEST(GatheredDirect, RefusesASingularMatrix) {
  const auto map = make_map(is_root(world()) ? 2 : 0, world());
  std::vector<std::vector<Entry>> rows;
  if (is_root(world()))
    rows = {{{0, 1}, {1, 0}}, {{0, 0}, {1, 0}}};
  EXPECT_THROW(gathered_direct(matrix_from_rows(map, rows), "test"), SolveError);
}

/// B V B^T / C for one solid dof, which pushes the first pressure and all but cancels for the
/// second.
TEST(AddedMassDiagonal, WeightsThatCancelToRoundOffMoveNothing) {
  const bool mine = world()->getRank() == 0;
  const auto cells = make_map(mine ? 2 : 0, world()), dofs = make_map(mine ? 1 : 0, world());
  std::vector<std::vector<Entry>> coupling, solid;
  if (mine) {
    coupling.push_back({{0, 3.0}, {1, 2e-14}});
    solid.push_back({{0, 4.0}});
  }
  BlockSystem system;
  const std::vector<std::vector<Entry>> nothing(cells->getNodeNumElements());
  system.set_blocks(as_operator(matrix_from_rows(cells, nothing)),
                    matrix_from_rows(dofs, coupling, cells),
                    as_operator(matrix_from_rows(dofs, solid)));
  const auto diagonal = added_mass_diagonal(system, cells);
  if (mine) {
    EXPECT_DOUBLE_EQ(diagonal->getData()[0], 9.0 / 4.0);
    EXPECT_EQ(diagonal->getData()[1], 0);
  }
}

/// As in the mass matrix of a turned body, where R J R^T is symmetric up to round-off only.
TEST(BlockDiagonal, AZeroOnOneSideOfTheDiagonalCountsNothingTwice) {
  for (const auto& [above, below] : {std::pair(0., 1e-17), std::pair(1e-17, 0.)}) {
    const auto map = make_map(is_root(world()) ? 3 : 0, world());
    std::vector<std::vector<Entry>> rows;
    if (is_root(world()))
      rows = {{{0, 2}, {1, above}}, {{0, below}, {1, 4}, {2, above}}, {{1, below}, {2, 5}}};
    const auto matrix = matrix_from_rows(map, rows);
    const auto blocks = block_diagonal_inverse(matrix, 24, "test");
    EXPECT_TRUE(blocks.exact);
    EXPECT_LT(inverse_error(*as_operator(matrix), *as_operator(blocks.inverse)), 1e-14);
  }
}

/// Rows 3k that no other row has; of the others 3k+1 has 3k+2, wherever it lives, but that has not
/// it.
TEST(BlockDiagonal, RowsOfTheirOwnStayBesideOthers) {
  for (const double beside : {0., 1e-17, 0.5}) {
    const int n_local = world()->getRank() == 0 ? 7 : 4;
    const auto map = make_map(n_local, world());
    const auto n = static_cast<GlobalIndex>(map->getGlobalNumElements());
    std::vector<std::vector<Entry>> rows(n_local);
    for (int row = 0; row < n_local; ++row) {
      const GlobalIndex id = map->getGlobalElement(row);
      if (id % 3 == 2)
        rows[row].push_back({id - 1, beside > 0.1 ? beside : 0});
      rows[row].push_back({id, 2.0 + static_cast<double>(id)});
      if (id % 3 == 1 && id + 1 < n)
        rows[row].push_back({id + 1, beside});
    }
    const auto matrix = matrix_from_rows(map, rows);
    const auto blocks = block_diagonal_inverse(matrix, 24, "test");
    EXPECT_TRUE(blocks.exact);
    EXPECT_LT(inverse_error(*as_operator(matrix), *as_operator(blocks.inverse)), 1e-14);
    const GlobalIndex n_pairs = n / 3;
    const auto n_entries = static_cast<GlobalIndex>(blocks.inverse->getGlobalNumEntries());
    if (beside == 0) {
      EXPECT_EQ(n_entries, n);
    }
    if (beside > 0.1) {
      EXPECT_EQ(n_entries, n + 2 * n_pairs);
    }
  }
}

TEST(BlockDiagonal, InvertsBlocksThatSpanRanks) {
  const SaddleProblem problem(world(), {});
  const auto solid = assembled(problem.system.solid_block());
  const auto blocks = block_diagonal_inverse(solid, 24, "test");
  EXPECT_TRUE(blocks.exact);
  EXPECT_EQ(blocks.inverse->getGlobalNumEntries(), 18u);
  EXPECT_LT(inverse_error(*problem.system.solid_block(), *as_operator(blocks.inverse)), 1e-14);
}

TEST(BlockDiagonal, LargeComponentsFallBackToTheDiagonal) {
  const auto blocks = block_diagonal_inverse(tridiagonal(40), 24, "test");
  EXPECT_FALSE(blocks.exact);
  EXPECT_EQ(blocks.inverse->getGlobalNumEntries(), 40u);
  const auto small = block_diagonal_inverse(tridiagonal(24), 24, "test");
  EXPECT_TRUE(small.exact);
  EXPECT_LT(inverse_error(*as_operator(tridiagonal(24)), *as_operator(small.inverse)), 1e-13);
}

// Rates of joints have rows without a mass, which their bodies make good.
TEST(BlockDiagonal, BlocksAreSmallWhateverTheirValues) {
  EXPECT_FALSE(has_small_blocks(tridiagonal(40), 24));
  EXPECT_TRUE(has_small_blocks(tridiagonal(24), 24));
  const RCP<CrsMatrix> zero = rcp(new CrsMatrix(*tridiagonal(40), Teuchos::Copy));
  zero->resumeFill();
  zero->setAllToScalar(0);
  zero->fillComplete();
  EXPECT_TRUE(has_small_blocks(zero, 24));
}

TEST(BlockDiagonal, RefusesAnIndefiniteBlock) {
  SaddleOptions options;
  options.plate_mass = -1;
  const SaddleProblem problem(world(), options);
  EXPECT_THROW(block_diagonal_inverse(assembled(problem.system.solid_block()), 24, "test"),
               SolveError);
}

TEST(ExactInverse, IsExactForEveryKindOfMatrix) {
  EXPECT_LT(inverse_error(*as_operator(tridiagonal(200)),
                          *exact_inverse(as_operator(tridiagonal(200)), "test")),
            1e-11);
  EXPECT_LT(inverse_error(
                *as_operator(tridiagonal(200)),
                *conjugate_gradient_inverse(as_operator(tridiagonal(200)), 1e-14, 1000, "test")),
            1e-10);
}

}  // namespace lockstep::test
