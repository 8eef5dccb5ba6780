#include "linear/action_operator.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>
#include <utility>

namespace lockstep {

namespace {

using Operator = Tpetra::Operator<double, int, GlobalIndex>;

class ActionOperator : public Operator {
 public:
  ActionOperator(const RCP<const Map>& map, Action action)
      : map_(map), action_(std::move(action)) {}

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    if (alpha == 1 && beta == 0) {
      for (std::size_t column = 0; column < x.getNumVectors(); ++column)
        action_(*x.getVector(column), *y.getVectorNonConst(column));
      return;
    }
    Vector result(map_);
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      action_(*x.getVector(column), result);
      y.getVectorNonConst(column)->update(alpha, result, beta);
    }
  }

 private:
  RCP<const Map> map_;
  Action action_;
};

}  // namespace

RCP<const LinearOperator> action_operator(const RCP<const Map>& map, Action action) {
  const RCP<const Operator> op = rcp(new ActionOperator(map, std::move(action)));
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(op);
}

}  // namespace lockstep
