// The strategies that come with Lockstep keep the promises of SolverStrategy; broken ones are found
// out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Vector.hpp>
#include <optional>

#include "base/errors.hpp"
#include "conformance/strategy_conformance.hpp"
#include "solve/solver_file.hpp"
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
  if (registry.contains(name))
    return registry.create(name, ParameterList());
  const ParameterList list =
      read_solver_file(fmt::format("{}/{}.xml", SOLVERS_DIRECTORY, name), world()).list;
  return registry.create(list.get<std::string>("Type"), list);
}

class ShippedStrategy : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedStrategy, KeepsItsPromises) {
  EXPECT_THAT(check_strategy([] { return shipped(GetParam()); }, world(), {}), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Conformance, ShippedStrategy,
                         ::testing::Values("paper", "schur-cg", "direct", "pressure-schur",
                                           "block-elimination", "minres-teko", "block-lu",
                                           "gauss-seidel", "simple"));

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
