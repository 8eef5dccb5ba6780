#include "strategies/uzawa/uzawa.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/null_space.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

namespace {

/// A residual that has grown so much above its smallest value will not come back.
constexpr double hopeless_growth = 1e4;

}  // namespace

ParameterList Uzawa::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Preconditioner of the inner conjugate gradients on A. Default: "
                           "Automatic.");
  declare_positive(list, "Relaxation", 0.5,
                   "omega [1]; must be below 2 / (1 + added mass / solid mass)");
  declare_between(list, "Inner Tolerance", 1e-2, 1e-14, 0.5,
                  "What an inner solve with A reduces its residual by [1]");
  return list;
}

Uzawa::Uzawa(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")) {
  const ParameterList list = with_defaults(given, valid_parameters());
  relaxation_ = list.get<double>("Relaxation");
  inner_tolerance_ = list.get<double>("Inner Tolerance");
}

void Uzawa::build(const BlockSystem& system, bool, bool) {
  if (system.has_solid())
    refuse_region_closed_by_solid(system);
}

int Uzawa::correct(const BlockSystem& system, const CorrectionRequest& request,
                   Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  const CrsMatrix& coupling = *system.coupling_transposed;
  Vector residual(*request.residual, Teuchos::Copy), step(correction.getMap());
  Vector inner_residual(residual.getMap());  // the inner solve uses it up
  Vector force(coupling.getRangeMap()), velocity(coupling.getRangeMap());
  correction.putScalar(0);
  double norm = request.residual_norm, smallest = norm, growth = 1;
  int n_iterations = 0;
  while (norm > request.target && n_iterations < request.maximum_iterations) {
    CorrectionRequest inner = request;
    inner_residual.assign(residual);
    inner.residual = &inner_residual;
    inner.target = inner_tolerance_ * norm;
    inner.update_target = nullptr;
    pressure_cg(system, inner, step);
    ++n_iterations;
    correction.update(relaxation_, step, 1);
    // residual -= omega S step
    apply(*system.pressure.op, step, residual, -relaxation_, 1);
    coupling.apply(step, force);
    apply(*solid_inverse(), force, velocity);
    coupling.apply(velocity, residual, Teuchos::TRANS, -relaxation_, 1);
    project_out(system.null_space, residual);
    const double previous = norm;
    norm = residual.norm2();
    growth = norm / previous;
    smallest = std::min(smallest, norm);
    check_solve(
        norm < hopeless_growth * smallest,
        "{}: the partitioned iteration diverges (residual {:.1e} of its smallest value "
        "after {} iterations): the added mass of the fluid outweighs the solid. It grows by "
        "{:.2f} an iteration, so that \"Relaxation\" {:.2g} would have to be below {:.2g}; "
        "or choose schur-cg.",
        request.name, norm / smallest, n_iterations, growth, relaxation_,
        2 * relaxation_ / (1 + growth));
  }
  return n_iterations;
}

}  // namespace lockstep
