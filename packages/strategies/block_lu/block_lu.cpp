#include "strategies/block_lu/block_lu.hpp"

#include <Teko_LU2x2PreconditionerFactory.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>

#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_schur.hpp"

namespace lockstep {

ParameterList BlockLu::valid_parameters() {
  ParameterList list = gmres_parameters();
  declare_positive(list, "Largest Solid", 300,
                   "Systems of more solid unknowns are refused: A is inverted once for each");
  return list;
}

BlockLu::BlockLu(const ParameterList& given)
    : GmresStrategy(with_defaults(given, valid_parameters()),
                    pressure_inverse_list(given, "Automatic")),
      largest_solid_(with_defaults(given, valid_parameters()).get<int>("Largest Solid")) {}

RCP<const LinearOperator> BlockLu::make_preconditioner(const BlockSystem& system,
                                                       const ScaledSystem& scaled) {
  refuse_region_closed_by_solid(system);
  // Teko's Schur complement is -A_11 + A_10 A_00^-1 A_01.
  Teko::LinearOp pressure = Thyra::scale<double>(1 / (scaled.s * scaled.s), pressure_inverse());
  Teko::LinearOp solid = Thyra::scale<double>(
      1 / (scaled.t * scaled.t),
      SolidSchur::make(system, pressure_inverse(), largest_solid_, name())->inverse());
  const Teko::LU2x2PreconditionerFactory factory(pressure, solid);
  return Thyra::prec<double>(factory, scaled.op)->getUnspecifiedPrecOp();
}

}  // namespace lockstep
