// The strategies that come with Lockstep keep the promises of SolverStrategy; broken ones are found
// out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>
#include <optional>

#include "base/errors.hpp"
#include "conformance/strategy_conformance.hpp"
#include "strategies/register_strategies.hpp"
#include "support/world.hpp"

namespace lockstep::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::unique_ptr<SolverStrategy> shipped(const std::string& name) {
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  ParameterList list;
  if (name == "uzawa")
    list.set("Relaxation", 0.3);
  return registry.create(name, list);
}

class ShippedStrategy : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedStrategy, KeepsItsPromises) {
  if (GetParam() == "uzawa" && world()->getSize() > 1)
    GTEST_SKIP() << "many iterations, and nothing parallel of its own";
  EXPECT_THAT(check_strategy([] { return shipped(GetParam()); }, world()), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Conformance, ShippedStrategy,
                         ::testing::Values("paper", "schur-cg", "direct", "pressure-schur",
                                           "solid-schur", "block-lu", "gauss-seidel", "simple",
                                           "bramble-pasciak", "uzawa", "block-elimination"));

/// Breaks nothing by itself.
class Wrapped : public SolverStrategy {
 public:
  std::string name() const override { return "wrapped"; }
  void prepare(const BlockSystem& system) override { inner_->prepare(system); }
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    return inner_->solve(system, rhs, solution, request);
  }

 protected:
  std::unique_ptr<SolverStrategy> inner_ = shipped("direct");
};

struct ClaimsToBeDone : Wrapped {
  SolveReport solve(const BlockSystem&, const BlockVector&, BlockVector&,
                    const SolveRequest&) override {
    return {};
  }
};
struct KeepsTheFirstSystem : Wrapped {
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    if (!first)
      first = system;
    return inner_->solve(*first, rhs, solution, request);
  }
  std::optional<BlockSystem> first;
};
struct TakesAnything : Wrapped {
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    try {
      return inner_->solve(system, rhs, solution, request);
    } catch (const SolveError&) {
      return {};
    }
  }
};
struct AlwaysIterates : Wrapped {
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    SolveReport report = inner_->solve(system, rhs, solution, request);
    report.iterations = 3;
    return report;
  }
};

template <typename Strategy>
Violations found() {
  return check_strategy([] { return std::make_unique<Strategy>(); }, world());
}

TEST(BrokenStrategy, IsNamed) {
  EXPECT_THAT(found<Wrapped>(), IsEmpty());
  EXPECT_THAT(found<ClaimsToBeDone>(),
              Contains(HasSubstr("pressure rows not to the tolerance [open tank")));
  EXPECT_THAT(found<KeepsTheFirstSystem>(), Contains(HasSubstr("another C: ")));
  EXPECT_THAT(found<TakesAnything>(), Contains(HasSubstr("that is not a number")));
  EXPECT_THAT(found<TakesAnything>(), Contains(HasSubstr("that no flow can have")));
  EXPECT_THAT(found<AlwaysIterates>(), Contains(HasSubstr("from an exact guess")));
}

}  // namespace
}  // namespace lockstep::test
