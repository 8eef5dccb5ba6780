#include "linear/gathered_operator.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "base/library_message.hpp"

namespace lockstep {

namespace {

class GatheredOperator : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  GatheredOperator(const RCP<const CrsMatrix>& matrix, const FactorOnRoot& factor,
                   const std::string& failure)
      : map_(matrix->getRowMap()) {
    const GlobalIndex n = static_cast<GlobalIndex>(map_->getGlobalNumElements());
    check_input(
        n == 0 || (map_->getMinAllGlobalIndex() == 0 && map_->getMaxAllGlobalIndex() == n - 1),
        "The direct solver wants rows numbered from 0 to {}. {}", n - 1, failure);
    const Communicator comm = map_->getComm();
    root_map_ = rcp(new Map(n, is_root(comm) ? static_cast<std::size_t>(n) : 0, 0, comm));
    gather_ = rcp(new Import(map_, root_map_));
    const RCP<const CrsMatrix> gathered = on_root(matrix);
    std::string message;
    if (is_root(comm) && n > 0) {  // libraries take no matrix of nothing
      try {
        solve_ = factor(*gathered);
      } catch (const std::exception& error) {
        message = failure + " " + library_message(error);
      }
    }
    throw_on_all(comm, message, static_cast<int>(ExitCode::solve_failed));
  }

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    MultiVector on_root(root_map_, 1), solution(map_, 1);
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      on_root.doImport(*x.getVector(column), *gather_, Tpetra::REPLACE);
      if (solve_)
        solve_(on_root.getDataNonConst(0).getRawPtr());
      solution.doExport(on_root, *gather_, Tpetra::REPLACE);
      y.getVectorNonConst(column)->update(alpha, *solution.getVector(0), beta);
    }
  }

 private:
  /// The matrix itself where one rank has all rows in this order. Collective.
  RCP<const CrsMatrix> on_root(const RCP<const CrsMatrix>& matrix) const {
    if (map_->getComm()->getSize() == 1 && map_->isSameAs(*root_map_))
      return matrix;
    const auto gathered = rcp(new CrsMatrix(root_map_, 0));
    gathered->doImport(*matrix, *gather_, Tpetra::INSERT);
    gathered->fillComplete(root_map_, root_map_);
    return gathered;
  }

  RCP<const Map> map_, root_map_;
  RCP<const Import> gather_;
  SolveInPlace solve_;  ///< empty on other ranks
};

}  // namespace

RCP<const LinearOperator> gathered_operator(const RCP<const CrsMatrix>& matrix,
                                            const FactorOnRoot& factor,
                                            const std::string& failure) {
  using Operator = Tpetra::Operator<double, int, GlobalIndex>;
  const RCP<const Operator> inverse = rcp(new GatheredOperator(matrix, factor, failure));
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(inverse);
}

}  // namespace lockstep
