#include "coupling/stacked_operator.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

namespace lockstep {

StackedOperator::StackedOperator(std::vector<StackedPart> parts, double dt,
                                 RCP<const CrsMatrix> added, RCP<const Map> map,
                                 IdentityRows identity)
    : parts_(std::move(parts)),
      dt_(dt),
      added_(std::move(added)),
      map_(std::move(map)),
      identity_(std::move(identity)) {}

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
  const Reduction& reduction = identity_.reduction;
  for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
    const RCP<const Vector> given = x.getVector(column);
    const RCP<Vector> target = y.getVectorNonConst(column);
    Vector result(map_);
    if (reduction.is_identity()) {
      apply_to(*given, result);
    } else {
      Vector velocity(*given, Teuchos::Copy), unknowns(*given, Teuchos::Copy);
      reduction.expand_change(velocity);
      apply_to(velocity, result);
      reduction.restrict(result);
      reduction.select(unknowns);
      result.update(1, *given, -1, unknowns, 1);
    }
    for (const int row : identity_.padding)
      result.sumIntoLocalValue(row, given->getData()[row]);
    target->update(alpha, result, beta);
  }
}

RCP<const LinearOperator> as_thyra(
    const RCP<const Tpetra::Operator<double, int, GlobalIndex>>& op) {
  // Making a space takes collectives: one serves both sides where it can.
  const auto range = Thyra::createVectorSpace<double, int, GlobalIndex>(op->getRangeMap());
  const bool is_square = op->getDomainMap().get() == op->getRangeMap().get();
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(
      op, range,
      is_square ? range : Thyra::createVectorSpace<double, int, GlobalIndex>(op->getDomainMap()));
}

}  // namespace lockstep
