#include "strategies/gauss_seidel/gauss_seidel.hpp"

#include <Teko_GaussSeidelPreconditionerFactory.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>

#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList GaussSeidel::valid_parameters() {
  return gmres_parameters();
}

GaussSeidel::GaussSeidel(const ParameterList& given)
    : GmresStrategy(with_defaults(given, valid_parameters()),
                    pressure_inverse_list(given, "Automatic")) {}

RCP<const LinearOperator> GaussSeidel::make_preconditioner(const BlockSystem&,
                                                           const ScaledSystem& scaled) {
  const auto pressure = Thyra::scale<double>(1 / (scaled.s * scaled.s), pressure_inverse());
  const auto solid_part = Thyra::scale<double>(-1 / (scaled.t * scaled.t), solid().approximate());
  const Teko::GaussSeidelPreconditionerFactory factory(Teko::GS_UseLowerTriangle, pressure,
                                                       solid_part);
  return Thyra::prec<double>(factory, scaled.op)->getUnspecifiedPrecOp();
}

}  // namespace lockstep
