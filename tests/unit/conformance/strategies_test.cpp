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

/// As docs/solvers.md says.
std::set<std::string> refusals_of(const std::string& name) {
  const std::string region_of_a_piston = "closed tank, plates of 50 kg, a piston";
  if (name == "uzawa")
    return {region_of_a_piston, "open tank, plates of 1 kg"};
  if (name == "solid-schur" || name == "block-lu" || name == "bramble-pasciak")
    return {region_of_a_piston};
  return {};
}

class ShippedStrategy : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedStrategy, KeepsItsPromises) {
  if (GetParam() == "uzawa" && world()->getSize() > 1)
    GTEST_SKIP() << "many iterations, and nothing parallel of its own";
  EXPECT_THAT(check_strategy([] { return shipped(GetParam()); }, world(), refusals_of(GetParam())),
              IsEmpty());
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

struct OpenTanksOnly : Wrapped {
  void prepare(const BlockSystem& system) override {
    check_solve(system.pressure_null_space.empty(), "Open tanks only.");
    inner_->prepare(system);
  }
};
struct FailsFromTheSolution : Wrapped {
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    check_solve(solution.pressure->norm2() == 0, "Begins at zero only.");
    return inner_->solve(system, rhs, solution, request);
  }
};

template <typename Strategy>
Violations found(const std::set<std::string>& may_refuse = {}) {
  return check_strategy([] { return std::make_unique<Strategy>(); }, world(), may_refuse);
}

TEST(BrokenStrategy, IsNamed) {
  EXPECT_THAT(found<Wrapped>(), IsEmpty());
  EXPECT_THAT(found<ClaimsToBeDone>(),
              Contains(HasSubstr("pressure rows not to the tolerance [open tank")));
  EXPECT_THAT(found<KeepsTheFirstSystem>(), Contains(HasSubstr("another C: ")));
  EXPECT_THAT(found<TakesAnything>(), Contains(HasSubstr("that is not a number")));
  EXPECT_THAT(found<TakesAnything>(), Contains(HasSubstr("that no flow can have")));
  EXPECT_THAT(found<AlwaysIterates>(), Contains(HasSubstr("iterates from an exact guess")));
  EXPECT_THAT(found<FailsFromTheSolution>(), Contains(HasSubstr("fails from an exact guess")));
}

TEST(BrokenStrategy, MayRefuseWhatItIsSaidToOnly) {
  EXPECT_THAT(found<OpenTanksOnly>(),
              Contains(HasSubstr("refuses a system [closed tank, no solids]: Open tanks only.")));
  const std::set<std::string> closed{"closed tank, plates of 50 kg",
                                     "closed tank, plates of 50 kg, a piston",
                                     "closed tank, no solids"};
  EXPECT_THAT(found<OpenTanksOnly>(closed), IsEmpty());
  EXPECT_THAT(found<OpenTanksOnly>({"closed tank, no solids"}),
              Contains(HasSubstr("refuses a system [closed tank, plates of 50 kg]")));
  EXPECT_THAT(found<Wrapped>({"tank"}), Contains(HasSubstr("no system \"tank\"")));
}

}  // namespace
}  // namespace lockstep::test
