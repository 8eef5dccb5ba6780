#include "strategies/common/belos_method.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Thyra_LinearOpWithSolveBase.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_PhysicallyBlockedLinearOpBase.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/vector_sums.hpp"
#include "solve/thyra_vectors.hpp"

namespace lockstep {

namespace {

/// Belos judges by the residual itself, which round-off lets fall no further in one go.
constexpr double strongest_reduction = 1e-9, weakest_reduction = 0.1;

/// Belos compares its recurrence in the norm of the preconditioner M with the 2-norm of the first
/// residual r: the factor of M that makes both the same for r.
double factor_of_equal_norms(const LinearOperator& preconditioner, const Vector& r,
                             const std::string& name) {
  Vector preconditioned(r.getMap());
  apply(preconditioner, r, preconditioned);
  const double energy = r.dot(preconditioned);
  check_solve(energy > 0,
              "{}: the preconditioner is not positive definite (r . M r = {:.3e}), but MINRES and "
              "conjugate gradients need one that is. Set \"Check Preconditioner Symmetry\" to see "
              "which part is not.",
              name, energy);
  return std::pow(norm(r), 2) / energy;
}

}  // namespace

struct BelosMethod::Trilinos {
  Stratimikos::DefaultLinearSolverBuilder builder;  ///< owns the lists that `factory` refers to
  RCP<Thyra::LinearOpWithSolveFactoryBase<double>> factory;
};

BelosMethod::BelosMethod(const Teuchos::ParameterList& list)
    : trilinos_(std::make_unique<Trilinos>()) {
  check_input(list.isType<std::string>("Solver Type"),
              "\"Linear Solver Types\", \"Belos\": the parameter \"Solver Type\" (string) is "
              "missing; MINRES, Block GMRES and TFQMR are some.");
  solver_ = list.get<std::string>("Solver Type");
  if (list.isSublist("Solver Types") && list.sublist("Solver Types").isSublist(solver_)) {
    const Teuchos::ParameterList& settings = list.sublist("Solver Types").sublist(solver_);
    if (settings.isType<double>("Convergence Tolerance"))
      tolerance_ = settings.get<double>("Convergence Tolerance");
    if (settings.isType<int>("Maximum Iterations"))
      maximum_iterations_ = settings.get<int>("Maximum Iterations");
  }
  const auto all = Teuchos::parameterList();
  all->set("Linear Solver Type", "Belos");
  all->set("Preconditioner Type", "None");
  all->sublist("Linear Solver Types").sublist("Belos").setParameters(list);
  try {
    trilinos_->builder.setParameterList(all);
    trilinos_->factory = trilinos_->builder.createLinearSolveStrategy("");
    trilinos_->factory->setVerbLevel(Teuchos::VERB_NONE);
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("Stratimikos does not take the list \"Belos\": {}", library_message(error)));
  }
}

BelosMethod::~BelosMethod() = default;

bool BelosMethod::is_symmetric() const {
  static const std::array<const char*, 5> symmetric = {"MINRES", "Block CG", "Pseudo Block CG",
                                                       "Pseudo Block Stochastic CG", "RCG"};
  return std::find(symmetric.begin(), symmetric.end(), solver_) != symmetric.end();
}

int BelosMethod::correct(const BlockSystem& system, const FlatSystem& flat,
                         const RCP<const LinearOperator>& preconditioner, const Vector& rhs,
                         const BlockKrylovRequest& request, Vector& pressure) const {
  const double t = request.solid_target > 0 ? request.target / request.solid_target : 1;
  const RCP<const LinearOperator> op = flat.scaled(system.op(), t);
  const RCP<Vector> b = make_vector(flat.map()), x = make_vector(flat.map());
  const double size = norm(rhs);
  flat.pressure_part(*b)->update(1 / size, rhs, 0);
  const auto solver = trilinos_->factory->createOp();
  const auto limits = Teuchos::parameterList();
  limits->set("Maximum Iterations", maximum_iterations_ > 0
                                        ? std::min(maximum_iterations_, request.maximum_iterations)
                                        : request.maximum_iterations);
  const Thyra::SolveCriteria<double> criteria(
      Thyra::SolveMeasureType(Thyra::SOLVE_MEASURE_NORM_RESIDUAL,
                              Thyra::SOLVE_MEASURE_NORM_INIT_RESIDUAL),
      std::clamp(std::max(request.target / size, tolerance_), strongest_reduction,
                 weakest_reduction),
      limits);
  try {
    if (preconditioner.is_null()) {
      Thyra::initializeOp<double>(*trilinos_->factory, op, solver.ptr());
    } else {
      const auto scaled = flat.scaled(preconditioner, 1 / t);
      const double factor = is_symmetric() ? factor_of_equal_norms(*scaled, *b, request.name) : 1;
      Thyra::initializePreconditionedOp<double>(
          *trilinos_->factory, op,
          Thyra::unspecifiedPrec<double>(flat.scaled(preconditioner, 1 / t, factor)), solver.ptr());
    }
    const auto status =
        Thyra::solve<double>(*solver, Thyra::NOTRANS, *as_thyra(b, op->range()),
                             as_thyra(x, op->domain()).ptr(), Teuchos::constPtr(criteria));
    pressure.update(size, *flat.pressure_part(*x), 0);
    return status.extraParameters->get<int>("Iteration Count");
  } catch (const Failure&) {
    throw;
  } catch (const std::exception& error) {
    throw SolveError(fmt::format(
        "{}: Belos' {} broke down ({}). MINRES and conjugate gradients need a symmetric positive "
        "definite preconditioner (set \"Check Preconditioner Symmetry\"), conjugate gradients a "
        "positive definite system, which Eq. 16 is not.",
        request.name, solver_, library_message(error)));
  }
}

Teuchos::ParameterList minres_list() {
  Teuchos::ParameterList list;
  list.set("Solver Type", "MINRES");
  return list;
}

}  // namespace lockstep
