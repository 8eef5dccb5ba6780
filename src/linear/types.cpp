#include "linear/types.hpp"

#include <Thyra_TpetraLinearOp.hpp>
#include <Thyra_TpetraMultiVector.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/stencil_operator.hpp"

namespace lockstep {

namespace {

using TpetraOperator = Tpetra::Operator<double, int, GlobalIndex>;
using ThyraTpetra = Thyra::TpetraLinearOp<double, int, GlobalIndex>;

/// The Tpetra operator that `op` wraps, or null.
RCP<const TpetraOperator> wrapped(const LinearOperator& op) {
  const auto* wrapper = dynamic_cast<const ThyraTpetra*>(&op);
  return wrapper == nullptr ? Teuchos::null : wrapper->getConstTpetraOperator();
}

void apply_as(const LinearOperator& op, bool transposed, const Vector& x, Vector& y, double alpha,
              double beta) {
  if (const auto inner = wrapped(op);
      !inner.is_null() && (!transposed || inner->hasTransposeApply())) {
    inner->apply(x, y, transposed ? Teuchos::TRANS : Teuchos::NO_TRANS, alpha, beta);
    return;
  }
  const auto domain = transposed ? op.range() : op.domain();
  const auto range = transposed ? op.domain() : op.range();
  // Multivectors of one column, for MueLu's operator takes no Thyra vectors.
  const auto x_thyra = Thyra::createConstMultiVector<double, int, GlobalIndex>(
      Teuchos::rcp_implicit_cast<const MultiVector>(Teuchos::rcpFromRef(x)), domain);
  const auto y_thyra = Thyra::createMultiVector<double, int, GlobalIndex>(
      Teuchos::rcp_implicit_cast<MultiVector>(Teuchos::rcpFromRef(y)), range);
  op.apply(transposed ? Thyra::TRANS : Thyra::NOTRANS, *x_thyra, y_thyra.ptr(), alpha, beta);
}

}  // namespace

RCP<const Map> make_map(int n_local, const Communicator& comm) {
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     static_cast<std::size_t>(n_local), 0, comm));
}

RCP<Vector> make_vector(const RCP<const Map>& map) {
  return rcp(new Vector(map));
}

RCP<const LinearOperator> as_operator(const RCP<const CrsMatrix>& matrix) {
  // Making a space takes collectives: one serves both sides where it can.
  const auto range = Thyra::createVectorSpace<double, int, GlobalIndex>(matrix->getRangeMap());
  const bool is_square = matrix->getDomainMap().get() == matrix->getRangeMap().get();
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(
      Teuchos::rcp_implicit_cast<const TpetraOperator>(matrix), range,
      is_square ? range
                : Thyra::createVectorSpace<double, int, GlobalIndex>(matrix->getDomainMap()));
}

RCP<const CrsMatrix> assembled(const RCP<const LinearOperator>& op) {
  if (op.is_null())
    return Teuchos::null;
  const auto inner = wrapped(*op);
  if (const auto* stencil = dynamic_cast<const StencilOperator*>(inner.get()))
    return stencil->assembled();
  return Teuchos::rcp_dynamic_cast<const CrsMatrix>(inner);
}

void apply(const LinearOperator& op, const Vector& x, Vector& y, double alpha, double beta) {
  apply_as(op, false, x, y, alpha, beta);
}

void apply_transposed(const LinearOperator& op, const Vector& x, Vector& y, double alpha,
                      double beta) {
  apply_as(op, true, x, y, alpha, beta);
}

}  // namespace lockstep
