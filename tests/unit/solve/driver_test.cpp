// A user's driver: the Thyra block operator, stock Stratimikos + Belos MINRES + Teko from a list.
#include <gtest/gtest.h>

#include <Teuchos_XMLParameterListHelpers.hpp>
#include <Tpetra_Core.hpp>

#include "conformance/saddle_problem.hpp"
#include "solve/solve_with_stratimikos.hpp"
#include "unit/solve/stratimikos_xml.hpp"

namespace lockstep::test {

TEST(Driver, SolvesEq16FromXml) {
  // 1. The operators and the right-hand side.
  const SaddleProblem problem(Tpetra::getDefaultComm(), {});
  const BlockVector rhs = problem.random_rhs();
  // 2. The solver, from XML.
  const auto list = Teuchos::getParametersFromXmlString(minres_with_teko);
  // 3. Solve, starting from zero.
  BlockVector solution = problem.zero();
  const auto report = solve_with_stratimikos(problem.system, rhs, solution, *list);
  EXPECT_GT(report.iterations, 0);
  EXPECT_LT(report.iterations, 80);
  EXPECT_LT(report.pressure_residual, 1e-6);
  EXPECT_LT(report.solid_residual, 1e-6);
  // 4. Once more from the solution: Belos alone would divide by zero at an exact guess.
  BlockVector exact = problem.zero();
  const auto again = solve_with_stratimikos(problem.system, problem.zero(), exact, *list);
  EXPECT_EQ(again.iterations, 0);
  EXPECT_EQ(exact.pressure->norm2(), 0);
}

}  // namespace lockstep::test
