#include "conformance/strategy_conformance.hpp"

#include <Tpetra_Vector.hpp>
#include <limits>
#include <optional>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "solve/block_residual.hpp"

namespace lockstep {

namespace {

using Make = std::function<std::unique_ptr<SolverStrategy>()>;

constexpr double tolerance = 1e-10;
const SolveRequest request{"conformance", tolerance};

std::string described(const SaddleOptions& options) {
  return fmt::format(
      "{} tank{}{}", options.open_top ? "open" : "closed",
      options.with_solid ? fmt::format(", plates of {:g} kg", options.plate_mass) : ", no solids",
      options.elastic_wall ? ", a piston" : "");
}

/// Returns the message that the action threw; empty if it went through. A refusal is the same on
/// all ranks.
std::string refusal_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SolveError& error) {
    return error.what();
  }
  return "";
}

/// Checks that the solution solves the problem, and that the report is true.
void check_solution(const SaddleProblem& problem, const BlockVector& rhs,
                    const BlockVector& solution, const SolveReport& report,
                    const std::string& where, Violations& found) {
  const BlockResidual residual = block_residual(problem.system, rhs, solution);
  expect_small(found, residual.relative_pressure(), tolerance,
               "solve: pressure rows not to the tolerance" + where);
  expect_small(found, report.pressure_residual, tolerance,
               "solve: reports a pressure residual above the tolerance" + where);
  if (!problem.system.has_solid())
    return;
  expect_small(found, residual.relative_solid(), tolerance,
               "solve: solid rows not to the tolerance" + where);
}

/// The fluid alone after a solve of the whole, as F2 comes after S1, and the whole once more.
void check_fluid_alone(SolverStrategy& strategy, const SaddleProblem& problem,
                       const std::string& where, Violations& found) {
  BlockSystem alone = problem.system;
  alone.set_blocks(problem.system.pressure_block());
  alone.null_space = problem.system.pressure_null_space;
  BlockVector rhs{rcp(new Vector(*problem.random_rhs().pressure, Teuchos::Copy)), Teuchos::null};
  project_out(alone.null_space, *rhs.pressure);
  BlockVector x{make_vector(rhs.pressure->getMap()), Teuchos::null};
  const std::string refusal = refusal_of([&] {
    strategy.prepare(alone);
    strategy.solve(alone, rhs, x, request);
    expect_small(found, block_residual(alone, rhs, x).relative_pressure(), tolerance,
                 "solve: the fluid alone not to the tolerance" + where);
  });
  expect_true(found, refusal.empty(), "solve: refuses the fluid alone" + where + ": " + refusal);
  const BlockVector both = problem.random_rhs();
  BlockVector again = problem.zero();
  const std::string second = refusal_of([&] {
    const SolveReport report = strategy.solve(problem.system, both, again, request);
    check_solution(problem, both, again, report, where + ", after the fluid alone", found);
  });
  expect_true(found, second.empty(), "solve: fails after the fluid alone" + where + ": " + second);
}

/// A second system of the same name: the strategy must see by the versions that C is another.
void check_versions(SolverStrategy& strategy, SaddleProblem& problem, const std::string& where,
                    Violations& found) {
  SaddleOptions heavier = problem.options();
  heavier.plate_mass *= 100;
  const SaddleProblem other(problem.comm(), heavier);
  problem.system.set_blocks(problem.system.pressure_block(), problem.system.coupling_transposed(),
                            other.system.solid_block());
  problem.system.solids.version = 2;
  const BlockVector rhs = problem.random_rhs(), solution = problem.zero();
  BlockVector x = solution;
  const std::string refusal = refusal_of([&] {
    strategy.prepare(problem.system);
    const SolveReport report = strategy.solve(problem.system, rhs, x, request);
    check_solution(problem, rhs, x, report, where + ", another C", found);
  });
  expect_true(found, refusal.empty(),
              "prepare: fails where C changed and its version says so" + where + ": " + refusal);
  // A strategy that solves for another system than it is given may crash on vectors without solids.
  if (found.empty())
    check_fluid_alone(strategy, problem, where, found);
}

/// Right-hand sides that have no solution, or are none.
void check_refusals(const Make& make, const SaddleProblem& problem, const std::string& where,
                    Violations& found) {
  const auto strategy = make();
  strategy->prepare(problem.system);
  const auto solve = [&](const BlockVector& rhs) {
    BlockVector x = problem.zero();
    return refusal_of([&] { strategy->solve(problem.system, rhs, x, request); });
  };
  BlockVector rhs = problem.random_rhs();
  rhs.pressure->putScalar(std::numeric_limits<double>::quiet_NaN());
  expect_true(found, !solve(rhs).empty(),
              "solve: takes a right-hand side that is not a number" + where);
  if (problem.system.null_space.empty())
    return;
  rhs = problem.random_rhs();
  rhs.pressure->update(1e-3, *problem.system.null_space.vector(0), 1);
  expect_true(found, !solve(rhs).empty(),
              "solve: takes a right-hand side that no flow can have" + where);
}

/// From the exact solution, and from nothing to nothing.
void check_easy_solves(SolverStrategy& strategy, const SaddleProblem& problem,
                       const BlockVector& rhs, BlockVector& solution, const std::string& where,
                       Violations& found) {
  std::string refusal = refusal_of([&] {
    const SolveReport warm =
        strategy.solve(problem.system, rhs, solution, {"conformance", 10 * tolerance});
    expect_true(found, warm.iterations == 0, "solve: iterates from an exact guess" + where);
  });
  expect_true(found, refusal.empty(), "solve: fails from an exact guess" + where + ": " + refusal);
  BlockVector nothing = problem.zero();
  refusal = refusal_of([&] { strategy.solve(problem.system, problem.zero(), nothing, request); });
  expect_true(found, refusal.empty(),
              "solve: fails where nothing is to be done" + where + ": " + refusal);
  double size = nothing.pressure->normInf();
  if (problem.system.has_solid())
    size += nothing.solid->normInf();
  expect_small(found, size, 0, "solve: makes something of nothing" + where);
}

void check_system(const Make& make, const SaddleOptions& options, bool may_refuse,
                  const Communicator& comm, Violations& found) {
  const std::string where = " [" + described(options) + "]";
  SaddleProblem problem(comm, options);
  const auto strategy = make();
  BlockVector x = problem.zero();
  const BlockVector rhs = problem.random_rhs();
  std::optional<SolveReport> cold;
  const std::string refusal = refusal_of([&] {
    strategy->prepare(problem.system);
    cold = strategy->solve(problem.system, rhs, x, request);
  });
  if (!cold) {
    expect_true(found, may_refuse, "solve: refuses a system" + where + ": " + refusal);
    return;
  }
  check_solution(problem, rhs, x, *cold, where, found);
  check_easy_solves(*strategy, problem, rhs, x, where, found);
  check_refusals(make, problem, where, found);
  if (problem.system.has_solid())
    check_versions(*strategy, problem, where, found);
}

SaddleOptions tank(bool open_top, bool elastic_wall, double plate_mass, bool with_solid = true) {
  SaddleOptions options;
  options.open_top = open_top;
  options.elastic_wall = elastic_wall;
  options.plate_mass = plate_mass;
  options.with_solid = with_solid;
  return options;
}

}  // namespace

Violations check_strategy(const Make& make, const Communicator& comm,
                          std::set<std::string> may_refuse) {
  Violations found;
  for (const SaddleOptions& options :
       {tank(true, false, 50), tank(false, false, 50), tank(false, true, 50), tank(true, false, 1),
        tank(true, true, 1e5), tank(true, false, 1, false), tank(false, false, 1, false)})
    check_system(make, options, may_refuse.erase(described(options)) > 0, comm, found);
  for (const std::string& unknown : may_refuse)
    found.push_back("check_strategy: has no system \"" + unknown + "\" that may be refused");
  return found;
}

}  // namespace lockstep
