#include "strategies/gauss_seidel/gauss_seidel.hpp"

#include <Teko_GaussSeidelPreconditionerFactory.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>

#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_preconditioner.hpp"

namespace lockstep {

ParameterList GaussSeidel::valid_parameters() {
  ParameterList list = gmres_parameters();
  declare_solid_inverse(list);
  return list;
}

GaussSeidel::GaussSeidel(const ParameterList& given)
    : GmresStrategy(with_defaults(given, valid_parameters()),
                    pressure_inverse_list(given, "Automatic")),
      solid_list_(solid_inverse_list(given)) {}

RCP<const LinearOperator> GaussSeidel::make_preconditioner(const BlockSystem& system,
                                                           const ScaledSystem& scaled) {
  const auto pressure = Thyra::scale<double>(1 / (scaled.s * scaled.s), pressure_inverse());
  const auto solid = Thyra::scale<double>(
      -1 / (scaled.t * scaled.t), solid_preconditioner(system, solid_list_, solid_inverse()));
  const Teko::GaussSeidelPreconditionerFactory factory(Teko::GS_UseLowerTriangle, pressure, solid);
  return Thyra::prec<double>(factory, scaled.op)->getUnspecifiedPrecOp();
}

}  // namespace lockstep
