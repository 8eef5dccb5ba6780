#include "strategies/pressure_schur/pressure_schur.hpp"

#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_Vector.hpp>

#include "strategies/common/assembled_schur.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/woodbury.hpp"

namespace lockstep {

ParameterList PressureSchur::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A, which is extended to one "
                           "of A + B C^-1 B^T. Default: Automatic.");
  return list;
}

PressureSchur::PressureSchur(const ParameterList& given)
    : MinresStrategy(with_defaults(given, valid_parameters()),
                     pressure_inverse_list(given, "Automatic")),
      pressure_list_(pressure_inverse_list(given, "Automatic")) {}

RCP<const LinearOperator> PressureSchur::schur_inverse(const BlockSystem& system) {
  if (auto inverse = woodbury_inverse_within({}, system, [&] { return pressure_inverse(); });
      !inverse.is_null())
    return inverse;
  if (layout() != nullptr)
    return layout()->schur_inverse();
  BlockSystem schur = system;
  schur.set_blocks(as_operator(schur_with_diagonal(system)), system.coupling_transposed(),
                   system.solid_block());
  schur.pressure_null_space = system.null_space;
  return lockstep::pressure_inverse(schur, pressure_list_);
}

MinresStrategy::Preconditioners PressureSchur::make_preconditioners(const BlockSystem& system) {
  return {schur_inverse(system), solid().approximate()};
}

}  // namespace lockstep
