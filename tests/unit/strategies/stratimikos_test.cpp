// The strategy "stratimikos": solvers of Belos, factories of Teko and inverses of ours, by name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/solver_file.hpp"
#include "strategies/register_strategies.hpp"
#include "support/world.hpp"

namespace lockstep::test {

namespace {

using ::testing::HasSubstr;

ParameterList shipped_list(const std::string& name) {
  return read_solver_file(fmt::format("{}/{}.xml", SOLVERS_DIRECTORY, name), world()).list;
}

ParameterList& library_of(ParameterList& list) {
  return list.sublist("Preconditioner Types").sublist("Teko").sublist("Inverse Factory Library");
}

void set_solver(ParameterList& list, const std::string& name) {
  ParameterList belos;
  belos.set("Solver Type", name);
  list.sublist("Linear Solver Types").sublist("Belos") = belos;
}

/// Flexible GMRES with a factory of Teko for the whole, of which "Multigrid" and "Solids" are
/// parts.
ParameterList gmres_with(const ParameterList& factory) {
  ParameterList list = shipped_list("gauss-seidel");
  library_of(list).sublist("Coupled") = factory;
  return list;
}

ParameterList factory(const std::string& type,
                      const std::vector<std::pair<std::string, std::string>>& texts) {
  ParameterList list;
  list.set("Type", type);
  for (const auto& [name, text] : texts)
    list.set(name, text);
  return list;
}

struct SolvedByList {
  BlockVector solution;
  SolveReport report;
};

SolvedByList solve_by(const ParameterList& list, const SaddleProblem& problem,
                      double tolerance = 1e-10) {
  StrategyRegistry registry("solver strategy");
  register_strategies(registry);
  const auto strategy = registry.create(list.get<std::string>("Type"), list);
  SolvedByList result{problem.zero(), {}};
  strategy->prepare(problem.system);
  result.report =
      strategy->solve(problem.system, problem.random_rhs(), result.solution, {"test", tolerance});
  return result;
}

ParameterList direct() {
  ParameterList list;
  list.set("Type", "direct");
  return list;
}

void expect_exact(const ParameterList& list, const SaddleProblem& problem) {
  const SolvedByList exact = solve_by(direct(), problem, 1e-12), found = solve_by(list, problem);
  EXPECT_LT(relative_difference(*exact.solution.pressure, *found.solution.pressure), 1e-7);
  EXPECT_LT(relative_difference(*exact.solution.solid, *found.solution.solid), 1e-7);
}

template <typename Error>
std::string complaint(const ParameterList& list, const SaddleProblem& problem) {
  try {
    solve_by(list, problem);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

SaddleOptions closed(bool by_piston) {
  SaddleOptions options;
  options.open_top = false;
  options.elastic_wall = by_piston;
  return options;
}

}  // namespace

/// Open, closed, and closed by a piston, where A alone is singular.
TEST(Stratimikos, EverySolverOfBelosThatTakesAnIndefiniteSystem) {
  if (world()->getSize() > 2)
    GTEST_SKIP() << "nothing that two ranks do not show";
  for (const std::string name :
       {"MINRES", "Block GMRES", "Pseudo Block GMRES", "GCRODR", "TFQMR", "BiCGStab"}) {
    SCOPED_TRACE(name);
    ParameterList list = shipped_list(name == "MINRES" ? "minres-teko" : "gauss-seidel");
    set_solver(list, name);
    expect_exact(list, SaddleProblem(world(), {}));
    expect_exact(list, SaddleProblem(world(), closed(false)));
    expect_exact(list, SaddleProblem(world(), closed(true)));
  }
}

TEST(Stratimikos, FactoriesOfTeko) {
  if (world()->getSize() > 2)
    GTEST_SKIP() << "nothing that two ranks do not show";
  const std::vector<ParameterList> factories = {
      factory("Block Jacobi", {{"Inverse Type 1", "Multigrid"}, {"Inverse Type 2", "Solids"}}),
      factory("Block Gauss-Seidel",
              {{"Inverse Type 1", "Multigrid"}, {"Inverse Type 2", "Solids"}}),
      factory("Block Gauss-Seidel", {{"Inverse Type 1", "MueLu"}, {"Inverse Type 2", "Solids"}}),
      factory("Block Gauss-Seidel",
              {{"Inverse Type 1", "Incomplete Cholesky"}, {"Inverse Type 2", "Lockstep Solid"}}),
      factory("NS SIMPLE",
              {{"Inverse Velocity Type", "Multigrid"}, {"Inverse Pressure Type", "Solids"}}),
      factory("SPD Block Diagonal",
              {{"Fluid Inverse Type", "Incomplete Cholesky"}, {"Solid Inverse Type", "Solids"}})};
  for (const ParameterList& one : factories) {
    SCOPED_TRACE(one.get<std::string>("Type"));
    ParameterList list = gmres_with(one);
    ParameterList& muelu = library_of(list).sublist("MueLu");
    muelu.set("Type", "MueLu");
    muelu.set("verbosity", "none");
    muelu.set("coarse: type", "RELAXATION");
    expect_exact(list, SaddleProblem(world(), {}));
    expect_exact(list, SaddleProblem(world(), closed(false)));
    expect_exact(list, SaddleProblem(world(), closed(true)));
  }
}

/// Factories of Teko for one block, here A beside an exact inverse of C.
TEST(Stratimikos, FactoriesOfTekoForOneBlock) {
  if (world()->getSize() > 2)
    GTEST_SKIP() << "nothing that two ranks do not show";
  ParameterList neumann = factory("Neumann Series", {{"Scaling Type", "Diagonal"}});
  neumann.set("Number of Terms", 3);
  ParameterList repeated =
      factory("Iterative Preconditioner", {{"Preconditioner Type", "Incomplete Cholesky"}});
  repeated.set("Iteration Count", 2);
  for (const ParameterList& one :
       {neumann, repeated,
        factory("Diagonal Scaling", {{"Inverse Factory", "Incomplete Cholesky"}}),
        factory("Explicit Diagonal Preconditioner", {{"Diagonal Type", "AbsRowSum"}})}) {
    SCOPED_TRACE(one.get<std::string>("Type"));
    ParameterList list = gmres_with(
        factory("Block Jacobi", {{"Inverse Type 1", "A"}, {"Inverse Type 2", "Solids"}}));
    library_of(list).sublist("A").setParameters(one);
    expect_exact(list, SaddleProblem(world(), {}));
  }
}

/// Our inverses, by their parameters: in an open and a closed tank, and where a piston closes it.
TEST(Stratimikos, InversesOfOurs) {
  std::vector<ParameterList> lists(5, shipped_list("minres-teko"));
  library_of(lists[0]).sublist("Multigrid").set("Sweeps", 3);  // MueLu does not know this parameter
  library_of(lists[1]).sublist("Schur").set("Largest Solid", 1);
  library_of(lists[2]).sublist("Schur").set("Largest Solid", 1);
  library_of(lists[2]).sublist("Schur").set("Inverse Type", std::string("Incomplete Cholesky"));
  library_of(lists[3]).sublist("Solids").set("Exact", true);
  library_of(lists[4]).sublist("Solids").sublist("Inverse").set("Type", std::string("Jacobi"));
  for (std::size_t i = 0; i < lists.size(); ++i) {
    SCOPED_TRACE(i);
    expect_exact(lists[i], SaddleProblem(world(), {}));
    expect_exact(lists[i], SaddleProblem(world(), closed(false)));
    expect_exact(lists[i], SaddleProblem(world(), closed(true)));
  }
}

/// A alone is singular in a closed tank. So much fill makes the incomplete factors all but exact,
/// with a last pivot of round-off unless a cell is pinned.
TEST(Stratimikos, FactorsOfAClosedTankAreRegular) {
  ParameterList list = shipped_list("minres-teko");
  library_of(list).sublist("Coupled").set("Fluid Inverse Type", std::string("Factors"));
  ParameterList& factors = library_of(list).sublist("Factors");
  factors.set("Type", std::string("Ifpack2"));
  factors.set("Prec Type", std::string("ILUT"));
  factors.set("Overlap", 0);
  factors.sublist("Ifpack2 Settings").set("fact: ilut level-of-fill", 40.0);
  factors.sublist("Ifpack2 Settings").set("fact: drop tolerance", 0.0);
  for (const bool by_piston : {false, true}) {
    const SaddleProblem problem(world(), closed(by_piston));
    expect_exact(list, problem);
    EXPECT_LT(solve_by(list, problem).report.iterations, 80);
  }
}

/// Eq. 16 is indefinite, which conjugate gradients do not take; the partitioned iteration converges
/// where the solids are heavy.
TEST(Stratimikos, MethodsOutsideTheirDomainSaySo) {
  ParameterList list = shipped_list("minres-teko");
  set_solver(list, "Block CG");
  EXPECT_THAT(complaint<SolveError>(list, SaddleProblem(world(), {})),
              HasSubstr("conjugate gradients a positive definite system"));
  SaddleOptions heavy;
  heavy.plate_mass = 1e5;
  expect_exact(shipped_list("uzawa"), SaddleProblem(world(), heavy));
}

/// BiCGStab wants no symmetric preconditioner, whatever letters are in its name.
TEST(Stratimikos, BiCGStabTakesAnUnsymmetricPreconditioner) {
  ParameterList list = shipped_list("gauss-seidel");
  set_solver(list, "BiCGStab");
  list.set("Check Preconditioner Symmetry", true);
  expect_exact(list, SaddleProblem(world(), {}));
}

TEST(Stratimikos, WithoutAPreconditioner) {
  ParameterList list = shipped_list("minres-teko");
  list.set("Preconditioner Type", "None");
  list.remove("Preconditioner Types");
  expect_exact(list, SaddleProblem(world(), {}));
}

/// The strategy pressure-schur as a list gives the same solve.
TEST(Stratimikos, MinresWithTekoIsPressureSchur) {
  ParameterList by_name;
  by_name.set("Type", "pressure-schur");
  for (const double mass : {1e-2, 50., 1e6}) {
    SaddleOptions options = closed(false);
    options.plate_mass = mass;
    const SaddleProblem problem(world(), options);
    const SolvedByList a = solve_by(by_name, problem),
                       b = solve_by(shipped_list("minres-teko"), problem);
    EXPECT_LT(relative_difference(*a.solution.pressure, *b.solution.pressure), 1e-7);
    EXPECT_NEAR(a.report.iterations, b.report.iterations, 2);
  }
}

/// "Lockstep Solid" is the strategy's "Solid Inverse", whatever sign the factory takes off -C: with
/// the diagonal of a C that ties its unknowns together each takes more iterations.
TEST(Stratimikos, SolidsAreInvertedAsTheStrategySays) {
  SaddleProblem problem(world(), {});
  const RCP<const Map> dofs = domain_map(*problem.system.solid_block());
  const auto n = static_cast<GlobalIndex>(dofs->getGlobalNumElements());
  std::vector<std::vector<Entry>> rows;
  for (const GlobalIndex dof : dofs->getNodeElementList()) {
    rows.push_back({{dof, 100.0}});
    for (const GlobalIndex other : {dof - 1, dof + 1}) {
      if (other >= 0 && other < n)
        rows.back().push_back({other, 49.0});
    }
  }
  problem.system.set_blocks(problem.system.pressure_block(), problem.system.coupling_transposed(),
                            as_operator(RCP<const CrsMatrix>(matrix_from_rows(dofs, rows))));
  for (const std::string name : {"minres-teko", "gauss-seidel"}) {
    const auto iterations = [&](const std::string& type) {
      ParameterList list = shipped_list(name);
      list.sublist("Solid Inverse").set("Type", type);
      return solve_by(list, problem).report.iterations;
    };
    EXPECT_GT(iterations("Jacobi"), iterations("Exact") + 2) << name;
  }
}

/// Each solve of Belos stops where the list says, and the next goes on from there.
TEST(Stratimikos, ShortSolvesAddUp) {
  ParameterList list = shipped_list("minres-teko");
  list.sublist("Linear Solver Types")
      .sublist("Belos")
      .sublist("Solver Types")
      .sublist("MINRES")
      .set("Convergence Tolerance", 1e-2);
  const SaddleProblem problem(world(), {});
  expect_exact(list, problem);
  EXPECT_GT(solve_by(list, problem).report.iterations,
            solve_by(shipped_list("minres-teko"), problem).report.iterations);
}

TEST(Stratimikos, NonConvergenceCarriesTheNumbers) {
  ParameterList list = shipped_list("minres-teko");
  list.set("Maximum Iterations", 3);
  const std::string message = complaint<SolveError>(list, SaddleProblem(world(), {}));
  EXPECT_THAT(message, HasSubstr("by stratimikos did not converge in 3 iterations"));
  EXPECT_THAT(message, HasSubstr("\"Maximum Iterations\" is 3"));
}

TEST(Stratimikos, AnUnsymmetricPreconditionerIsCaughtOnRequest) {
  ParameterList list = gmres_with(factory(
      "Block Gauss-Seidel", {{"Inverse Type 1", "Multigrid"}, {"Inverse Type 2", "Solids"}}));
  set_solver(list, "MINRES");
  list.set("Check Preconditioner Symmetry", true);
  EXPECT_THAT(complaint<SolveError>(list, SaddleProblem(world(), {})),
              HasSubstr("preconditioner of the coupled system"));
}

TEST(Stratimikos, ListsThatCannotWorkAreRefused) {
  const SaddleProblem problem(world(), {});
  ParameterList list = shipped_list("minres-teko");
  list.set("Linear Solver Type", "Amesos2");
  EXPECT_THAT(complaint<InputError>(list, problem),
              HasSubstr("\"Linear Solver Type\" is \"Amesos2\""));
  list = shipped_list("minres-teko");
  list.set("Preconditioner Type", "MueLu");
  EXPECT_THAT(complaint<InputError>(list, problem), HasSubstr("Eq. 16 consists of blocks"));
  list = shipped_list("minres-teko");
  set_solver(list, "");
  EXPECT_THROW(solve_by(list, problem), InputError);
  list = shipped_list("minres-teko");
  library_of(list).sublist("Another").set("Type", "Lockstep Multigrid");
  library_of(list).sublist("Schur").set("Inverse Type", "Another");
  library_of(list).sublist("Coupled").set("Solid Inverse Type", "Multigrid");
  EXPECT_THAT(complaint<InputError>(list, problem), HasSubstr("two lists of type"));
  list = shipped_list("minres-teko");
  library_of(list).sublist("Coupled").set("Solid Inverse Type", "Multigrid");
  EXPECT_THAT(complaint<InputError>(list, problem),
              HasSubstr("\"Lockstep Multigrid\" is one of the pressure block A alone"));
  list = shipped_list("minres-teko");
  library_of(list).sublist("Multigrid").set("Sweeps", 0);
  EXPECT_THAT(complaint<InputError>(list, problem), HasSubstr("\"Sweeps\" (int, from 1 to 100)"));
  list = shipped_list("minres-teko");
  library_of(list).sublist("Schur").set("Largest Solid", 18.0);
  EXPECT_THAT(complaint<InputError>(list, problem),
              HasSubstr("\"Largest Solid\" must be of type int"));
  list = shipped_list("lsc");
  if (world()->getSize() > 1) {
    EXPECT_THAT(complaint<InputError>(list, problem), HasSubstr("NS LSC ends the program"));
  }
  library_of(list).sublist("Coupled").set("Assume Stable Discretisation", true);
  EXPECT_THAT(complaint<InputError>(list, problem),
              HasSubstr("Did you mean \"Assume Stable Discretization\"?"));
  list = shipped_list("minres-teko");
  library_of(list).sublist("Multigrid").set("Sweps", 2);
  EXPECT_THAT(complaint<InputError>(list, problem),
              HasSubstr("\"Sweps\" is not a parameter of \"Lockstep Multigrid\""));
  list = shipped_list("minres-teko");
  library_of(list).sublist("Schur").set("Inverse Type", "Coupled");
  EXPECT_THAT(complaint<InputError>(list, problem), HasSubstr("refers to itself"));
}

/// Teko prints why it fails; the message has it.
TEST(Stratimikos, WhatTekoSaysArrives) {
  if (world()->getSize() > 1)
    GTEST_SKIP() << "LSC is refused on several ranks";
  ParameterList list = shipped_list("lsc");
  library_of(list).sublist("Coupled").set("Assume Stable Discretization", false);
  EXPECT_THAT(complaint<SolveError>(list, SaddleProblem(world(), {})), HasSubstr("Anasazi"));
}

}  // namespace lockstep::test
