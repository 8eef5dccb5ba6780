#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include <algorithm>

#include "linear/symmetry_check.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid_cases.hpp"

namespace lockstep::test {
namespace {

/// Levels of more than 100 cells on every second rank, every fourth where they are gathered again.
MultigridOptions gathering(bool is_w_cycle) {
  MultigridOptions options;
  options.is_w_cycle = is_w_cycle;
  options.most_replicated_cells = 100;
  options.gathered_ranks = 2;
  return options;
}
/// All levels but the finest on every rank.
MultigridOptions replicating(bool is_w_cycle) {
  MultigridOptions options;
  options.is_w_cycle = is_w_cycle;
  options.most_replicated_cells = 1 << 30;
  return options;
}

/// A closed square of n^2 cells in blocks of four along each axis, dealt out like cards.
std::shared_ptr<const LatticeBlocks> square(int n) {
  LatticeBlocks blocks;
  blocks.dimension = 2;
  blocks.n_cells = {n, n, 1};
  blocks.width = 4;
  blocks.comm = Tpetra::getDefaultComm();
  for (int j = 0, number = 0; j < n; j += blocks.width) {
    for (int i = 0; i < n; i += blocks.width) {
      if (number++ % blocks.comm->getSize() == blocks.comm->getRank())
        blocks.begins.push_back({i, j, 0});
    }
  }
  return std::make_shared<const LatticeBlocks>(std::move(blocks));
}

/// Poisson's equation on it, with a fixed pressure beyond the lower side.
FaceCoefficients open_below(const std::shared_ptr<const LatticeBlocks>& blocks) {
  FaceCoefficients coefficients;
  coefficients.blocks = blocks;
  for_each_cell(*blocks, [&](std::size_t, const std::array<int, 3>& at) {
    coefficients.lower[0].push_back(at[0] > 0 ? 1 : 0);
    coefficients.lower[1].push_back(at[1] > 0 ? 1 : 0);
    coefficients.dirichlet.push_back(at[1] == 0 ? 2 : 0);
  });
  return coefficients;
}

/// One cycle for a rough right-hand side, by cell of this rank.
std::vector<float> one_cycle(const FaceCoefficients& coefficients,
                             const std::shared_ptr<const LatticeLayout>& layout,
                             const MultigridOptions& options) {
  Multigrid<2> multigrid(layout, options);
  multigrid.set(coefficients);
  const auto place = [&](const std::array<int, 3>& at) { return local_cell(layout->finest(), at); };
  for_each_cell(layout->blocks(), [&](std::size_t, const std::array<int, 3>& at) {
    multigrid.rhs(place(at).colour)[place(at).slot] = static_cast<float>(
        std::sin(0.1 * at[0] + 0.02 * at[1]) + std::cos(1e3 * at[0] + 3e3 * at[1]));
  });
  multigrid.cycle([](int) {}, [](int) {});
  std::vector<float> solution;
  for_each_cell(layout->blocks(), [&](std::size_t, const std::array<int, 3>& at) {
    solution.push_back(multigrid.solution(place(at).colour)[place(at).slot]);
  });
  return solution;
}

/// 288^2 cells in blocks of 4 are gathered at 72^2 cells and again at 18^2.
TEST(GatheredLevels, EachCellOfALevelHasOneHolder) {
  const auto blocks = square(288);
  const LatticeLayout layout(blocks, gathering(false).layout());
  const int n_ranks = blocks->comm->getSize(), rank = blocks->comm->getRank();
  if (n_ranks == 1)
    GTEST_SKIP() << "one rank holds all levels whole";
  ASSERT_EQ(layout.levels().size(), 6U);
  for (int level = 0; level < 5; ++level) {
    const LayoutLevel& stored = layout.levels()[level];
    EXPECT_TRUE(stored.grid.is_distributed);
    const GlobalIndex n_owned = std::count(stored.owned.begin(), stored.owned.end(), 1);
    const GlobalIndex n = 288 >> level;
    EXPECT_EQ(sum_all(blocks->comm, n_owned), n * n) << "level " << level;
    const int rank_stride = level < 2 ? 1 : level < 4 ? 2 : 4;
    EXPECT_EQ(n_owned > 0, rank % rank_stride == 0) << "level " << level;
    EXPECT_EQ(stored.landing != nullptr, level == 2 || level == 4) << "level " << level;
  }
  EXPECT_FALSE(layout.levels().back().grid.is_distributed);
}

/// Sums in another order are all that may differ.
TEST(GatheredLevels, ACycleIsThatOfWholeLevels) {
  const auto blocks = square(288);
  const FaceCoefficients coefficients = open_below(blocks);
  for (const bool is_w_cycle : {false, true}) {
    const auto cycle_with = [&](const MultigridOptions& options) {
      return one_cycle(coefficients,
                       std::make_shared<const LatticeLayout>(blocks, options.layout()), options);
    };
    const auto gathered = cycle_with(gathering(is_w_cycle));
    const auto whole = cycle_with(replicating(is_w_cycle));
    double largest = 0, difference = 0;
    for (std::size_t cell = 0; cell < whole.size(); ++cell) {
      largest = std::max<double>(largest, std::abs(whole[cell]));
      difference = std::max<double>(difference, std::abs(whole[cell] - gathered[cell]));
    }
    largest = max_all(blocks->comm, largest);
    EXPECT_GT(largest, 1);
    EXPECT_LT(difference, 1e-5 * largest);
  }
}

/// Compares with the cycle of whole levels for a fluid with a plate, behind which cells move to
/// other coarse cells, and to those of other ranks. The smoothest part of a rough right-hand side
/// weighs n^2 times its roughest in the solution, and so does round-off in it.
template <int dim>
void expect_the_cycle_of_whole_levels(const Problem<dim>& problem, double round_off) {
  for (const bool is_w_cycle : {false, true}) {
    const auto cycle_with = [&](const MultigridOptions& options) {
      const auto layout = PressureLayout::make(problem.system, options, nullptr);
      Vector b(layout->map()), z(layout->map());
      const auto rhs = make_vector(problem.fluid->pressure_map());
      pseudo_random(*rhs, 5);
      layout->to_layout(*rhs, b);
      apply(*layout->inverse(), b, z);
      const auto result = make_vector(rhs->getMap());
      layout->from_layout(z, *result);
      return result;
    };
    const auto gathered = cycle_with(gathering(is_w_cycle));
    const auto whole = cycle_with(replicating(is_w_cycle));
    const double size = whole->norm2();
    gathered->update(-1, *whole, 1);
    EXPECT_LT(gathered->norm2(), round_off * size) << (is_w_cycle ? "W" : "V");
  }
}

/// The plates lie in the middle of blocks, so that cells move where the level is gathered, beside
/// the middle of the domain, where ranks meet, or beside a periodic seam.
TEST(GatheredLevels, BehindAPlate2D) {
  for (const bool is_periodic : {false, true}) {
    Case<2> scene({1024, 512}, 1.0 / 512);
    scene.side("y upper", "open");
    if (is_periodic)
      scene.side("x lower", "periodic").side("x upper", "periodic");
    for (const double face : {504.1, 1016.1}) {
      SCOPED_TRACE(face);
      expect_the_cycle_of_whole_levels(Problem<2>(scene, plate<2>(1.0 / 512, face / 512)), 1e-4);
    }
  }
}

TEST(GatheredLevels, BehindAPlate3D) {
  Case<3> scene({128, 64, 64}, 1.0 / 64);
  scene.side("z upper", "open");
  expect_the_cycle_of_whole_levels(Problem<3>(scene, plate<3>(1.0 / 64, 60.1 / 64)), 1e-5);
}

}  // namespace
}  // namespace lockstep::test
