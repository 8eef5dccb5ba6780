#include "linear/residual_operator.hpp"

#include <Thyra_TpetraLinearOp.hpp>

namespace lockstep {

const ResidualOperator* residual_operator_of(const RCP<const LinearOperator>& op) {
  const auto* wrapper =
      dynamic_cast<const Thyra::TpetraLinearOp<double, int, GlobalIndex>*>(op.get());
  return wrapper == nullptr
             ? nullptr
             : dynamic_cast<const ResidualOperator*>(wrapper->getConstTpetraOperator().get());
}

}  // namespace lockstep
