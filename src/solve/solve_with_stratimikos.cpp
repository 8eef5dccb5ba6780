#include "solve/solve_with_stratimikos.hpp"

#include <Thyra_LinearOpWithSolveBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "solve/block_residual.hpp"
#include "solve/stratimikos.hpp"
#include "solve/thyra_vectors.hpp"

namespace lockstep {

StratimikosReport solve_with_stratimikos(const BlockSystem& system, const BlockVector& rhs,
                                         BlockVector& solution,
                                         const Teuchos::ParameterList& list) {
  check_no_empty_rank(system, "Stratimikos");
  const auto op = system.has_solid() ? block_operator(system) : system.pressure.op;
  const BlockVector b = signed_rhs(rhs);
  const auto solver = linear_op_with_solve(op, list);
  StratimikosReport report;
  // Belos divides by the initial residual.
  if (block_residual(system, rhs, solution).norm() > 0) {
    const auto b_thyra = system.has_solid() ? as_thyra(b, *op) : as_thyra(b.pressure, op->range());
    const auto x_thyra =
        system.has_solid() ? as_thyra(solution, *op) : as_thyra(solution.pressure, op->domain());
    Thyra::SolveStatus<double> status;
    try {
      status = Thyra::solve<double>(*solver, Thyra::NOTRANS, *b_thyra, x_thyra.ptr());
    } catch (const std::exception& error) {
      throw SolveError(
          fmt::format("Belos broke down on the {}: {}. MINRES needs a symmetric positive "
                      "definite preconditioner.",
                      system.name, library_message(error)));
    }
    if (!status.extraParameters.is_null())
      report.iterations = status.extraParameters->get("Iteration Count", 0);
    check_solve(
        status.solveStatus == Thyra::SOLVE_STATUS_CONVERGED,
        "Belos did not converge on the {}: relative residual {:.2e} after {} iterations. Raise "
        "\"Maximum Iterations\" or choose another preconditioner.",
        system.name, status.achievedTol, report.iterations);
  }
  const BlockResidual residual = block_residual(system, rhs, solution);
  report.pressure_residual = residual.relative_pressure();
  report.solid_residual = residual.relative_solid();
  return report;
}

}  // namespace lockstep
