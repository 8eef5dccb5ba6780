#include "linear/stencil_operator.hpp"

#include <Thyra_TpetraLinearOp.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>

namespace lockstep {

RCP<const LinearOperator> as_operator(const RCP<const StencilOperator>& op) {
  using Operator = Tpetra::Operator<double, int, GlobalIndex>;
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(
      Teuchos::rcp_implicit_cast<const Operator>(op));
}

const FaceCoefficients* stencil_of(const RCP<const LinearOperator>& op) {
  const auto* wrapper =
      dynamic_cast<const Thyra::TpetraLinearOp<double, int, GlobalIndex>*>(op.get());
  if (wrapper == nullptr)
    return nullptr;
  const auto* stencil =
      dynamic_cast<const StencilOperator*>(wrapper->getConstTpetraOperator().get());
  return stencil == nullptr ? nullptr : &stencil->coefficients();
}

}  // namespace lockstep
