#include "strategies/schur_cg.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/symmetry_check.hpp"
#include "strategies/pressure_cg.hpp"
#include "strategies/pressure_inverse.hpp"

namespace lockstep {

namespace {

ParameterList default_pressure_inverse() {
  ParameterList list;
  list.set("Type", "MueLu");
  return list;
}

}  // namespace

ParameterList SchurCg::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_inverse(
      list, "Pressure Inverse",
      "Approximate inverse of the pressure block A. Default: MueLu, smoothed aggregation "
      "with a Chebyshev(2) smoother.");
  return list;
}

SchurCg::SchurCg(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters())),
      pressure_list_(inverse_list(given, "Pressure Inverse", default_pressure_inverse())) {}

void SchurCg::build(const BlockSystem& system, bool geometry_changed, bool) {
  if (!geometry_changed)
    return;
  pressure_inverse_ = pressure_inverse(system, pressure_list_);
  if (check_symmetry())
    check_symmetric_positive(*pressure_inverse_, "pressure block of the " + system.name);
}

int SchurCg::correct(const BlockSystem& system, const CorrectionRequest& request,
                     Vector& correction) {
  const ConjugateGradientsRequest cg{request.name, request.target, request.maximum_iterations,
                                     system.null_space, request.update_target};
  if (!system.has_solid())
    return pressure_cg(system, *pressure_inverse_, *request.residual, cg, correction);
  const CrsMatrix& coupling = *system.coupling_transposed;
  Vector force(coupling.getRangeMap()), velocity(coupling.getRangeMap());
  const auto schur_complement = [&](const Vector& x, Vector& y) {
    apply(*system.pressure_block, x, y);
    coupling.apply(x, force);
    apply(*solid_inverse(), force, velocity);
    coupling.apply(velocity, y, Teuchos::TRANS, 1, 1);
  };
  return conjugate_gradients(
      schur_complement, [&](const Vector& x, Vector& y) { apply(*pressure_inverse_, x, y); },
      *request.residual, correction, cg);
}

}  // namespace lockstep
