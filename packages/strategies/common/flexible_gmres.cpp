#include <BelosLinearProblem.hpp>
#include <BelosSolverManager.hpp>
#include <BelosThyraAdapter.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_MultiVectorStdOps.hpp>
#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/belos_solvers.hpp"
#include "solve/thyra_vectors.hpp"
#include "strategies/common/block_krylov.hpp"

namespace lockstep {

namespace {

/// Belos' explicit residual test cannot be met far below this in one go.
constexpr double strongest_gmres_reduction = 1e-10;

RCP<Teuchos::ParameterList> gmres_list(double tolerance, int maximum_iterations, int restart) {
  const auto list = Teuchos::parameterList();
  list->set("Flexible Gmres", true);
  list->set("Num Blocks", restart);
  list->set("Maximum Iterations", maximum_iterations);
  list->set("Maximum Restarts", maximum_iterations / restart + 1);
  list->set("Convergence Tolerance", tolerance);
  return list;
}

/// |K u| / |u| for a pseudo-random u: the size of an operator, for scaling.
double size_of(const LinearOperator& op) {
  Vector u(domain_map(op)), v(u.getMap());
  pseudo_random(u, 1);
  apply(op, u, v);
  return v.norm2() / u.norm2();
}

}  // namespace

ScaledSystem scaled_system(const BlockSystem& system, const std::string& who) {
  check_no_empty_rank(system, who);
  ScaledSystem scaled;
  const double a = size_of(*system.pressure.op), c = size_of(*system.solids.op);
  scaled.s = a > 0 ? 1 / std::sqrt(a) : 1;
  scaled.t = 1 / std::sqrt(c);
  scaled.op = block_operator(system, scaled.s, scaled.t);
  return scaled;
}

int solve_by_flexible_gmres(const ScaledSystem& system, const Vector& rhs,
                            const BlockKrylovRequest& request, int restart, Vector& pressure) {
  using Vectors = Thyra::MultiVectorBase<double>;
  const auto space = Teuchos::rcp_dynamic_cast<const Thyra::DefaultProductVectorSpace<double>>(
      system.op->domain(), true);
  const RCP<Vectors> solution = Thyra::createMember<double>(space);
  const RCP<Vectors> right = Thyra::createMember<double>(space);
  const auto b = blocks_of(right);
  b[0]->update(system.s, rhs, 0);
  b[1]->putScalar(0);
  Thyra::assign<double>(solution.ptr(), 0.0);
  const double tolerance = std::clamp(request.target / rhs.norm2(), strongest_gmres_reduction, 0.1);
  try {
    const auto problem =
        rcp(new Belos::LinearProblem<double, Vectors, LinearOperator>(system.op, solution, right));
    problem->setRightPrec(system.preconditioner);
    problem->setProblem();
    const auto solver =
        belos_solver("Block GMRES", gmres_list(tolerance, request.maximum_iterations, restart));
    solver->setProblem(problem);
    solver->solve();
    pressure.update(system.s, *blocks_of(solution)[0], 0);
    return solver->getNumIters();
  } catch (const Failure&) {
    throw;
  } catch (const std::exception& error) {
    throw SolveError(
        fmt::format("{}: flexible GMRES broke down ({}).", request.name, library_message(error)));
  }
}

}  // namespace lockstep
