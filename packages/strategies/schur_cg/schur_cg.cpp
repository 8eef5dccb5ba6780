#include "strategies/schur_cg/schur_cg.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "strategies/common/pressure_cg.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList SchurCg::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  return list;
}

SchurCg::SchurCg(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")) {}

int SchurCg::correct(const BlockSystem& system, const CorrectionRequest& request,
                     Vector& correction) {
  const ConjugateGradientsRequest cg{request.name, request.target, request.maximum_iterations,
                                     iteration_null_space(system), request.update_target};
  if (!system.has_solid())
    return pressure_cg(system, *pressure_inverse(), *request.residual, cg, correction);
  const CrsMatrix& coupling = *system.coupling_transposed;
  Vector force(coupling.getRangeMap()), velocity(coupling.getRangeMap());
  const auto schur_complement = [&](const Vector& x, Vector& y) {
    apply(*system.pressure_block, x, y);
    coupling.apply(x, force);
    apply(*solid_inverse(), force, velocity);
    coupling.apply(velocity, y, Teuchos::TRANS, 1, 1);
  };
  return conjugate_gradients(
      schur_complement, [&](const Vector& x, Vector& y) { apply(*pressure_inverse(), x, y); },
      *request.residual, correction, cg);
}

}  // namespace lockstep
