#include <Thyra_BelosLinearOpWithSolveFactory.hpp>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultPreconditioner.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/vector_sums.hpp"
#include "solve/minres.hpp"
#include "solve/thyra_vectors.hpp"
#include "strategies/common/block_krylov.hpp"

namespace lockstep {

namespace {

const std::string parameter = "Krylov Method";
const std::string lockstep_name = "Lockstep MINRES", belos_name = "Belos MINRES";

/// Belos' explicit residual test cannot be met far below this in one go.
constexpr double strongest_minres_reduction = 1e-9;

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
  const double factor = std::pow(s * norm(rhs), 2) / energy;
  return Thyra::block2x2<double>(Thyra::scale<double>(factor / (s * s), pressure_inverse),
                                 Teuchos::null, Teuchos::null,
                                 Thyra::scale<double>(factor / (t * t), solid_inverse));
}

int belos_minres(const BlockSystem& system, const Vector& rhs, const BlockKrylovRequest& request,
                 const RCP<const LinearOperator>& pressure_inverse,
                 const RCP<const LinearOperator>& solid_inverse, Vector& pressure) {
  // Scaled symmetrically, so that both blocks' residuals mean the same.
  const double s = 1 / norm(rhs), t = s * request.target / request.solid_target;
  const auto op = block_operator(system, s, t);
  const RCP<const LinearOperator> preconditioner =
      scaled_preconditioner(pressure_inverse, solid_inverse, s, t, rhs);

  BlockVector b{make_vector(rhs.getMap()), make_vector(system.coupling_transposed->getRangeMap())};
  b.pressure->update(s, rhs, 0);
  const BlockVector x{make_vector(b.pressure->getMap()), make_vector(b.solid->getMap())};
  const double tolerance = std::clamp(request.target / norm(rhs), strongest_minres_reduction, 0.1);
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
        request.name, library_message(error)));
  }
}

int lockstep_minres(const BlockSystem& system, const Vector& rhs, const BlockKrylovRequest& request,
                    const RCP<const LinearOperator>& pressure_inverse,
                    const RCP<const LinearOperator>& solid_inverse, Vector& pressure) {
  const CrsMatrix& coupling = *system.coupling_transposed;
  const BlockAction op = [&](const Blocks& x, Blocks& y) {
    apply(*system.pressure.op, *x[0], *y[0]);
    coupling.apply(*x[1], *y[0], Teuchos::TRANS, -1, 1);
    apply(*system.solids.op, *x[1], *y[1]);
    coupling.apply(*x[0], *y[1], Teuchos::NO_TRANS, -1, -1);
  };
  const BlockAction precondition = [&](const Blocks& r, Blocks& z) {
    apply(*pressure_inverse, *r[0], *z[0]);
    apply(*solid_inverse, *r[1], *z[1]);
  };
  const auto solid_map = coupling.getRangeMap();
  const Blocks b{rcp(new Vector(rhs, Teuchos::Copy)), make_vector(solid_map)};
  Blocks x{make_vector(rhs.getMap()), make_vector(solid_map)};
  MinresRequest minres_request;
  minres_request.name = request.name;
  minres_request.maximum_iterations = request.maximum_iterations;
  minres_request.targets = {request.target, request.solid_target};
  const MinresReport report = minres(op, precondition, b, x, minres_request);
  pressure.update(1, *x[0], 0);
  return report.n_iterations;
}

}  // namespace

void declare_minres(ParameterList& list, const std::string& standard) {
  declare_choice(list, parameter, standard, {lockstep_name, belos_name},
                 "Lockstep MINRES (MINRES-QLP: right on singular systems, stops block by block) or "
                 "Belos MINRES");
}

MinresKind minres_kind(const ParameterList& list) {
  const auto& name = list.get<std::string>(parameter);
  check_input(name == lockstep_name || name == belos_name,
              "\"{}\" is \"{}\", but must be \"{}\" or \"{}\".", parameter, name, lockstep_name,
              belos_name);
  return name == belos_name ? MinresKind::belos : MinresKind::lockstep;
}

int solve_by_minres(MinresKind kind, const BlockSystem& system, const Vector& rhs,
                    const BlockKrylovRequest& request,
                    const RCP<const LinearOperator>& pressure_inverse,
                    const RCP<const LinearOperator>& solid_inverse, Vector& pressure) {
  if (kind == MinresKind::belos) {
    check_no_empty_rank(system, "Belos MINRES");
    return belos_minres(system, rhs, request, pressure_inverse, solid_inverse, pressure);
  }
  return lockstep_minres(system, rhs, request, pressure_inverse, solid_inverse, pressure);
}

}  // namespace lockstep
