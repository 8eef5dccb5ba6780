#include "coupling/stacked_operator.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

namespace lockstep {

StackedOperator::StackedOperator(std::vector<StackedPart> parts, double dt,
                                 RCP<const CrsMatrix> added, RCP<const Vector> mask,
                                 RCP<const Map> map)
    : parts_(std::move(parts)),
      dt_(dt),
      added_(std::move(added)),
      mask_(std::move(mask)),
      map_(std::move(map)) {}

void StackedOperator::apply_to(const Vector& x, Vector& y) const {
  y.putScalar(0);
  for (const StackedPart& part : parts_) {
    const RCP<const Vector> x_part = x.offsetView(part.map, part.local_begin)->getVector(0);
    const RCP<Vector> y_part =
        y.offsetViewNonConst(part.map, part.local_begin)->getVectorNonConst(0);
    lockstep::apply(*part.mass, *x_part, *y_part);
    if (!part.implicit_force.is_null()) {
      lockstep::apply(*part.implicit_force, *x_part, *y_part, -dt_, 1);
    }
  }
  if (!added_.is_null())
    added_->apply(x, y, Teuchos::NO_TRANS, 1, 1);
}

void StackedOperator::apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
                            double beta) const {
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const RCP<const Vector> given = x.getVector(column);
    const RCP<Vector> target = y.getVectorNonConst(column);
    Vector masked(*given, Teuchos::Copy), result(map_);
    if (!mask_.is_null())
      masked.elementWiseMultiply(1, *mask_, *given, 0);
    apply_to(masked, result);
    if (!mask_.is_null()) {
      Vector kept(*given, Teuchos::Copy);
      kept.update(-1, masked, 1);
      result.elementWiseMultiply(1, *mask_, Vector(result, Teuchos::Copy), 0);
      result.update(1, kept, 1);
    }
    target->update(alpha, result, beta);
  }
}

RCP<const LinearOperator> as_thyra(
    const RCP<const Tpetra::Operator<double, int, GlobalIndex>>& op) {
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(
      op, Thyra::createVectorSpace<double, int, GlobalIndex>(op->getRangeMap()),
      Thyra::createVectorSpace<double, int, GlobalIndex>(op->getDomainMap()));
}

}  // namespace lockstep
