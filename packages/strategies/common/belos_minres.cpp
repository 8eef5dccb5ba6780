#include "strategies/common/belos_minres.hpp"

#include <Thyra_BelosLinearOpWithSolveFactory.hpp>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultPreconditioner.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/thyra_vectors.hpp"

namespace lockstep {

namespace {

/// Belos' explicit residual test cannot be met far below this in one go.
constexpr double strongest_reduction = 1e-9;

Teuchos::RCP<Teuchos::ParameterList> belos_list(double tolerance, int maximum_iterations) {
  const auto list = Teuchos::parameterList();
  list->set("Solver Type", "MINRES");
  Teuchos::ParameterList& minres = list->sublist("Solver Types").sublist("MINRES");
  minres.set("Convergence Tolerance", tolerance);
  minres.set("Maximum Iterations", maximum_iterations);
  list->sublist("VerboseObject").set("Verbosity Level", "none");
  return list;
}

/// diag(M_A / s^2, M_C / t^2) for the scaled system, times the factor that makes its norm of the
/// initial residual equal to the 2-norm: Belos compares one with the other.
RCP<const LinearOperator> scaled_preconditioner(const RCP<const LinearOperator>& pressure_inverse,
                                                const RCP<const LinearOperator>& solid_inverse,
                                                double s, double t, const Vector& rhs) {
  Vector preconditioned(rhs.getMap());
  apply(*pressure_inverse, rhs, preconditioned);
  const double energy = rhs.dot(preconditioned);
  check_solve(energy > 0,
              "The preconditioner of MINRES is not positive definite (r . M r = {:.3e}).", energy);
  const double norm = s * rhs.norm2();
  const double factor = norm * norm / energy;
  return Thyra::block2x2<double>(Thyra::scale<double>(factor / (s * s), pressure_inverse),
                                 Teuchos::null, Teuchos::null,
                                 Thyra::scale<double>(factor / (t * t), solid_inverse));
}

}  // namespace

int belos_minres(const BlockSystem& system, const Vector& rhs, const MinresRequest& request,
                 const RCP<const LinearOperator>& pressure_inverse,
                 const RCP<const LinearOperator>& solid_inverse, Vector& pressure) {
  const double s = 1 / request.pressure_scale;
  const double t = request.solid_scale > 0 ? 1 / request.solid_scale : s;
  const auto op = block_operator(system, s, t);
  const RCP<const LinearOperator> preconditioner =
      scaled_preconditioner(pressure_inverse, solid_inverse, s, t, rhs);

  BlockVector b{make_vector(rhs.getMap()), make_vector(system.coupling_transposed->getRangeMap())};
  b.pressure->update(s, rhs, 0);
  const BlockVector x{make_vector(b.pressure->getMap()), make_vector(b.solid->getMap())};
  const double tolerance = std::clamp(request.target / rhs.norm2(), strongest_reduction, 0.1);
  try {
    Thyra::BelosLinearOpWithSolveFactory<double> factory;
    factory.setParameterList(belos_list(tolerance, request.maximum_iterations));
    factory.setVerbLevel(Teuchos::VERB_NONE);
    const auto solver = factory.createOp();
    Thyra::initializePreconditionedOp<double>(
        factory, op, Thyra::unspecifiedPrec<double>(preconditioner), solver.ptr());
    const auto status =
        Thyra::solve<double>(*solver, Thyra::NOTRANS, *as_thyra(b, *op), as_thyra(x, *op).ptr());
    pressure.update(s, *x.pressure, 0);
    return status.extraParameters->get<int>("Iteration Count");
  } catch (const std::exception& error) {
    throw SolveError(fmt::format(
        "{}: MINRES broke down ({}). Its preconditioner must be symmetric positive definite; set "
        "\"Check Preconditioner Symmetry\".",
        request.name, error.what()));
  }
}

}  // namespace lockstep
