// Every strategy on small coupled systems, against the direct one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/solver_file.hpp"
#include "steepest_descent.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/woodbury.hpp"
#include "strategies/register_strategies.hpp"
#include "support/world.hpp"

namespace lockstep::test {

namespace {

using ::testing::HasSubstr;

/// The strategy of that name, or the list of that name in xml-params/solvers.
std::unique_ptr<SolverStrategy> make(const std::string& name,
                                     const ParameterList& list = ParameterList()) {
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  add_strategy<SteepestDescent>(registry, "steepest-descent", "The tutorial's example");
  if (registry.contains(name))
    return registry.create(name, list);
  ParameterList shipped =
      read_solver_file(fmt::format("{}/{}.xml", SOLVERS_DIRECTORY, name), world()).list;
  shipped.setParameters(list);
  return registry.create(shipped.get<std::string>("Type"), shipped);
}

/// A list whose pressure inverse has this type.
ParameterList with_inverse(const std::string& type) {
  ParameterList list;
  list.sublist("Pressure Inverse").set("Type", type);
  return list;
}

struct Solved {
  BlockVector solution;
  SolveReport report;
};

Solved solve(SolverStrategy& strategy, const SaddleProblem& problem, double tolerance = 1e-10) {
  Solved result{problem.zero(), {}};
  strategy.prepare(problem.system);
  result.report =
      strategy.solve(problem.system, problem.random_rhs(), result.solution, {"test", tolerance});
  return result;
}

template <typename Action>
std::string solve_error(Action action) {
  try {
    action();
  } catch (const SolveError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

SaddleOptions tank(bool open_top, bool elastic_wall, double plate_mass) {
  SaddleOptions options;
  options.open_top = open_top;
  options.elastic_wall = elastic_wall;
  options.plate_mass = plate_mass;
  return options;
}

class EveryStrategy : public ::testing::TestWithParam<std::string> {};

}  // namespace

TEST_P(EveryStrategy, AgreesWithDirect) {
  if (GetParam() == "steepest-descent" && world()->getSize() > 1)
    GTEST_SKIP() << "many iterations, and nothing parallel of its own";
  // Open; closed, singular; closed by a piston, where A alone is singular; light and heavy plates.
  for (const SaddleOptions& options :
       {tank(true, false, 50), tank(false, false, 50), tank(false, true, 50), tank(true, false, 1),
        tank(true, true, 1e5)}) {
    SCOPED_TRACE(fmt::format("open {} piston {} mass {}", options.open_top, options.elastic_wall,
                             options.plate_mass));
    const SaddleProblem problem(world(), options);
    const Solved expected = solve(*make("direct"), problem, 1e-12);
    EXPECT_LE(expected.report.iterations, 3);
    const Solved found = solve(*make(GetParam()), problem);
    EXPECT_LT(relative_difference(*expected.solution.pressure, *found.solution.pressure), 1e-7);
    EXPECT_LT(relative_difference(*expected.solution.solid, *found.solution.solid), 1e-7);
    EXPECT_LE(found.report.pressure_residual, 1e-10);
    EXPECT_LE(found.report.solid_residual, 1e-13);
  }
}

TEST_P(EveryStrategy, SolvesFluidAlone) {
  for (const bool open_top : {true, false}) {
    SaddleOptions options = tank(open_top, false, 1);
    options.with_solid = false;
    const SaddleProblem problem(world(), options);
    const Solved expected = solve(*make("direct"), problem, 1e-12);
    const Solved found = solve(*make(GetParam()), problem);
    EXPECT_LT(relative_difference(*expected.solution.pressure, *found.solution.pressure), 1e-7);
  }
}

TEST_P(EveryStrategy, TakesExactAndWarmGuesses) {
  const SaddleProblem problem(world(), {});
  const auto strategy = make(GetParam());
  Solved cold = solve(*strategy, problem, 1e-10);
  BlockVector guess = cold.solution;
  const SolveReport exact =
      strategy->solve(problem.system, problem.random_rhs(), guess, {"test", 1e-9});
  EXPECT_EQ(exact.iterations, 0);
  EXPECT_LE(exact.pressure_residual, 1e-9);

  guess.pressure->scale(1 + 1e-4);
  const SolveReport warm =
      strategy->solve(problem.system, problem.random_rhs(), guess, {"test", 1e-10});
  if (GetParam() != "direct") {
    EXPECT_LT(warm.iterations, cold.report.iterations);
  }
  EXPECT_LE(warm.pressure_residual, 1e-10);

  // Nothing to do at all: zero right-hand side, zero guess.
  BlockVector zero = problem.zero();
  const SolveReport idle = strategy->solve(problem.system, problem.zero(), zero, {"test", 1e-10});
  EXPECT_EQ(idle.iterations, 0);
  EXPECT_EQ(zero.pressure->normInf() + zero.solid->normInf(), 0);
}

TEST_P(EveryStrategy, JudgesABlockWithoutRightHandSideByItsTerms) {
  const SaddleProblem problem(world(), {});
  const auto strategy = make(GetParam());
  BlockVector rhs = problem.random_rhs(), solution = problem.zero();
  rhs.pressure->putScalar(0);
  const SolveReport report = strategy->solve(problem.system, rhs, solution, {"test", 1e-10});
  EXPECT_LE(report.pressure_residual, 1e-10);
  EXPECT_GT(solution.pressure->normInf(), 0);
}

TEST_P(EveryStrategy, RefusesAnIncompatibleRightHandSide) {
  const SaddleProblem problem(world(), tank(false, false, 50));
  BlockVector rhs = problem.random_rhs(), solution = problem.zero();
  rhs.pressure->update(1e-3, *problem.system.null_space.vector(0), 1);
  EXPECT_THAT(solve_error([&] {
                make(GetParam())->solve(problem.system, rhs, solution, {"test", 1e-10});
              }),
              HasSubstr("not compatible with the null space"));
}

TEST_P(EveryStrategy, RefusesANotANumber) {
  const SaddleProblem problem(world(), {});
  BlockVector rhs = problem.random_rhs(), solution = problem.zero();
  rhs.pressure->putScalar(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(solve_error([&] {
                make(GetParam())->solve(problem.system, rhs, solution, {"test", 1e-10});
              }),
              HasSubstr("not finite"));
}

INSTANTIATE_TEST_SUITE_P(Strategies, EveryStrategy,
                         ::testing::Values("paper", "schur-cg", "direct", "pressure-schur",
                                           "block-elimination", "steepest-descent", "minres-teko",
                                           "block-lu", "gauss-seidel", "simple"));

TEST(Strategies, PreparedPartsAreReusedByVersion) {
  SaddleProblem problem(world(), {});
  const auto strategy = make("schur-cg");
  EXPECT_EQ(solve(*strategy, problem).report.preconditioner_builds, 1);
  const SolveReport again = solve(*strategy, problem).report;
  EXPECT_EQ(again.preconditioner_builds, 0);
  EXPECT_EQ(again.preconditioner_reuses, 1);
  ++problem.system.solids.version;
  EXPECT_EQ(solve(*strategy, problem).report.preconditioner_builds, 1);
}

TEST(Strategies, IterationsDoNotDependOnTheNumberOfRanks) {
  // Counts measured on one rank; the runs on 2 and 4 ranks must find them again.
  const SaddleProblem problem(world(), {});
  EXPECT_NEAR(solve(*make("schur-cg"), problem, 1e-8).report.iterations, 16, 2);
  EXPECT_NEAR(solve(*make("schur-cg", with_inverse("Jacobi")), problem, 1e-8).report.iterations, 83,
              2);
  EXPECT_NEAR(solve(*make("paper", with_inverse("Jacobi")), problem, 1e-8).report.iterations, 115,
              2);
}

TEST(Strategies, IncompleteCholeskyDependsLittleOnTheNumberOfRanks) {
  SaddleOptions options;
  options.n = 64;
  const SaddleProblem problem(world(), options);
  const int on_one_rank = 149;
  EXPECT_NEAR(solve(*make("paper"), problem, 1e-8).report.iterations, on_one_rank,
              0.1 * on_one_rank);
}

TEST(Strategies, NonConvergenceCarriesTheNumbers) {
  const SaddleProblem problem(world(), {});
  for (const std::string name : {"schur-cg", "paper"}) {
    ParameterList list = with_inverse("Jacobi");
    list.set("Maximum Iterations", 3);
    const std::string message = solve_error([&] { solve(*make(name, list), problem, 1e-8); });
    EXPECT_THAT(message, HasSubstr("Solve test of the coupled system by " + name));
    EXPECT_THAT(message, HasSubstr("did not converge in 3 iterations: pressure residual"));
    EXPECT_THAT(message, HasSubstr("required 1.00e-08"));
    EXPECT_THAT(message, HasSubstr("\"Maximum Iterations\" is 3"));
  }
}

TEST(Strategies, UnsymmetricPreconditionerIsCaughtOnRequest) {
  const SaddleProblem problem(world(), {});
  ParameterList list = with_inverse("Ifpack2");
  list.set("Check Preconditioner Symmetry", true);
  ParameterList& inverse = list.sublist("Pressure Inverse");
  inverse.set("Prec Type", "RELAXATION");
  inverse.sublist("Ifpack2 Settings").set("relaxation: type", "Gauss-Seidel");
  EXPECT_THAT(solve_error([&] { make("paper", list)->prepare(problem.system); }),
              HasSubstr("is not symmetric"));
}

TEST(Strategies, ExtremeDensitiesCostTheSchurStrategiesLittle) {
  // The spectrum of an ideal Schur complement does not know the plates' mass; C^-1 and A^-1 apart
  // do.
  for (const std::string name : {"pressure-schur", "minres-teko", "gauss-seidel"}) {
    std::vector<int> iterations;
    for (const double mass : {1e-2, 1e2, 1e6})
      iterations.push_back(solve(*make(name), SaddleProblem(world(), tank(true, true, mass)), 1e-8)
                               .report.iterations);
    SCOPED_TRACE(fmt::format("{}: {}", name, fmt::join(iterations, " ")));
    const auto [fewest, most] = std::minmax_element(iterations.begin(), iterations.end());
    if (name == "gauss-seidel")
      EXPECT_GT(*most, 1.5 * *fewest);
    else
      EXPECT_LE(*most, 1.5 * *fewest);
  }
}

TEST(Strategies, WoodburysFormulaIsForLightSolidsAlone) {
  const auto is_taken = [](double mass, const WoodburyLimits& limits) {
    const SaddleProblem problem(world(), tank(true, false, mass));
    Teuchos::ParameterList exact;
    exact.set("Type", "Direct");
    const auto inverse = [&] { return pressure_inverse(problem.system, exact); };
    return !woodbury_inverse_within(limits, problem.system, inverse).is_null();
  };
  EXPECT_TRUE(is_taken(1e-2, {}));
  EXPECT_FALSE(is_taken(50, {}));
  EXPECT_TRUE(is_taken(50, {6, 0}));
  EXPECT_FALSE(is_taken(1e-2, {5, 0}));  // two plates, of six unknowns
}

TEST(Strategies, BlockEliminationCountsItsEntries) {
  // A: five points, less the blocked faces; each plate joins the 2 x 8 cells beside it.
  const SaddleProblem problem(world(), {});
  const auto strategy = make("block-elimination");
  const SolveReport report = solve(*strategy, problem).report;
  const int n = 16, n_plate = 8, of_a = 5 * n * n - 4 * n - 2 * 2 * n_plate;
  const int dense = 2 * (2 * n_plate) * (2 * n_plate);
  const int in_both = 2 * (2 * n_plate + 2 * 2 * (n_plate - 1));
  EXPECT_EQ(report.stored_nonzeros, of_a + dense - in_both);
}

TEST(Strategies, EmptyRanks) {
  if (world()->getSize() < 2)
    GTEST_SKIP() << "needs a second rank";
  SaddleOptions options;
  options.n_empty_ranks = 1;
  const SaddleProblem problem(world(), options);
  const SaddleProblem everywhere(world(), {});
  const Solved expected = solve(*make("direct"), everywhere);
  for (const std::string name : {"schur-cg", "paper", "pressure-schur", "minres-teko"}) {
    SCOPED_TRACE(name);
    const ParameterList list = name == "minres-teko" ? ParameterList() : with_inverse("Jacobi");
    const Solved found = solve(*make(name, list), problem);
    EXPECT_LT(relative_difference(*expected.solution.solid, *found.solution.solid), 1e-7);
  }
}

TEST(Strategies, EverySolidInverseLeadsToTheSameSolution) {
  const SaddleProblem problem(world(), {});
  const Solved expected = solve(*make("direct"), problem);
  for (const std::string strategy : {"schur-cg", "pressure-schur"}) {
    for (const std::string type :
         {"Automatic", "Exact", "Jacobi", "Block Diagonal", "Direct", "Block Diagonal Mass",
          "Conjugate Gradients", "Incomplete Cholesky"}) {
      SCOPED_TRACE(strategy + ", " + type);
      ParameterList list;
      list.sublist("Solid Inverse").set("Type", type);
      const auto made = make(strategy, list);
      const Solved found = solve(*made, problem);
      EXPECT_LT(relative_difference(*expected.solution.solid, *found.solution.solid), 1e-7);
      const bool is_exact = type == "Automatic" || type == "Exact" || type == "Direct";
      EXPECT_EQ(made->inverses(), "A: MueLu; C: " + (is_exact ? "exact" : type));
    }
  }
}

/// Closed regions, where A is singular, by all inverses that the documentation lists.
TEST(Strategies, EveryPressureInverseTakesAClosedRegion) {
  for (const bool piston : {false, true}) {
    const SaddleProblem problem(world(), tank(false, piston, 50));
    const Solved expected = solve(*make("direct"), problem, 1e-12);
    for (const std::string type :
         {"Automatic", "Exact", "Conjugate Gradients", "Direct", "Incomplete Cholesky", "MueLu"}) {
      SCOPED_TRACE(type + (piston ? ", closed by a piston" : ""));
      const Solved found = solve(*make("schur-cg", with_inverse(type)), problem);
      EXPECT_LT(relative_difference(*expected.solution.pressure, *found.solution.pressure), 1e-7);
      EXPECT_LT(relative_difference(*expected.solution.solid, *found.solution.solid), 1e-7);
    }
  }
}

TEST(Strategies, MomentumIsExactWhereVelocitiesAreIteratedInStages) {
  SaddleProblem problem(world(), {});
  const RCP<const Map> dofs = domain_map(*problem.system.solid_block());
  const auto n = static_cast<GlobalIndex>(dofs->getGlobalNumElements());
  std::vector<std::vector<Entry>> rows;
  for (const GlobalIndex dof : dofs->getNodeElementList()) {
    rows.push_back({{dof, 50.0 * static_cast<double>(1 + dof * dof)}});
    for (const GlobalIndex other : {dof - 1, dof + 1}) {
      if (other >= 0 && other < n)
        rows.back().push_back({other, 20.0});
    }
  }
  problem.system.set_blocks(problem.system.pressure_block(), problem.system.coupling_transposed(),
                            as_operator(RCP<const CrsMatrix>(matrix_from_rows(dofs, rows))));
  ParameterList list;
  list.sublist("Solid Inverse").set("Type", "Conjugate Gradients");
  const Solved found = solve(*make("schur-cg", list), problem, 1e-3);
  EXPECT_GT(found.report.solid_iterations, 0);
  EXPECT_LT(found.report.solid_residual, 2e-14);
}

TEST(Strategies, MisspeltInverseIsAnInputError) {
  ParameterList list = with_inverse("MueLu");
  list.sublist("Pressure Inverse").set("smother: type", "CHEBYSHEV");
  EXPECT_THROW(make("schur-cg", list), InputError);
  ParameterList solid;
  solid.sublist("Solid Inverse").set("Type", "Automtic");
  EXPECT_THROW(make("schur-cg", solid), InputError);
}

}  // namespace lockstep::test
