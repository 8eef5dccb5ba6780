#include "linear/gathered_direct.hpp"

#include <Amesos2.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// The part that only rank 0 has.
struct Factorisation {
  RCP<CrsMatrix> matrix;
  RCP<MultiVector> rhs, solution;
  RCP<Amesos2::Solver<CrsMatrix, MultiVector>> solver;
};

class GatheredDirect : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  GatheredDirect(const RCP<const CrsMatrix>& matrix, const std::string& name)
      : map_(matrix->getRowMap()) {
    const GlobalIndex n = static_cast<GlobalIndex>(map_->getGlobalNumElements());
    check_input(map_->getMinAllGlobalIndex() == 0 && map_->getMaxAllGlobalIndex() == n - 1,
                "The direct solver wants the rows of the {} numbered from 0 to {}.", name, n - 1);
    const Communicator comm = map_->getComm();
    root_map_ = rcp(new Map(n, is_root(comm) ? static_cast<std::size_t>(n) : 0, 0, comm));
    gather_ = rcp(new Import(map_, root_map_));
    CrsMatrix gathered(root_map_, 0);
    gathered.doImport(*matrix, *gather_, Tpetra::INSERT);
    gathered.fillComplete(root_map_, root_map_);
    factor_on_root(gathered, name);
  }

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    MultiVector on_root(root_map_, 1), solution(map_, 1);
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      on_root.doImport(*x.getVector(column), *gather_, Tpetra::REPLACE);
      if (!factorisation_.solver.is_null())
        solve_on_root(on_root);
      solution.doExport(on_root, *gather_, Tpetra::REPLACE);
      y.getVectorNonConst(column)->update(alpha, *solution.getVector(0), beta);
    }
  }

 private:
  void factor_on_root(const CrsMatrix& gathered, const std::string& name) {
    std::string failure;
    if (is_root(map_->getComm())) {
      try {
        factor(gathered);
      } catch (const std::exception& error) {
        failure = fmt::format(
            "The direct solver cannot factor the {} ({} unknowns): the matrix is singular or not "
            "finite. Check that every region of fluid without an open side is among the null "
            "vectors. KLU2 says: {}",
            name, map_->getGlobalNumElements(), error.what());
      }
    }
    throw_on_all(map_->getComm(), failure, static_cast<int>(ExitCode::solve_failed));
  }

  void factor(const CrsMatrix& gathered) {
    const auto serial = rcp(
        new Map(map_->getGlobalNumElements(), 0, Communicator(rcp(new Teuchos::SerialComm<int>))));
    factorisation_.matrix = matrix_from_rows(serial, rows_of(gathered));
    factorisation_.rhs = rcp(new MultiVector(serial, 1));
    factorisation_.solution = rcp(new MultiVector(serial, 1));
    auto solver = Amesos2::create<CrsMatrix, MultiVector>(
        "KLU2", factorisation_.matrix, factorisation_.solution, factorisation_.rhs);
    solver->symbolicFactorization().numericFactorization();
    factorisation_.solver = solver;
  }

  void solve_on_root(MultiVector& on_root) const {
    {
      const auto from = on_root.getData(0);
      std::copy(from.begin(), from.end(), factorisation_.rhs->getDataNonConst(0).begin());
    }
    factorisation_.solver->solve();
    const auto from = factorisation_.solution->getData(0);
    std::copy(from.begin(), from.end(), on_root.getDataNonConst(0).begin());
  }

  RCP<const Map> map_, root_map_;
  RCP<const Import> gather_;
  Factorisation factorisation_;
};

}  // namespace

RCP<const LinearOperator> gathered_direct(const RCP<const CrsMatrix>& matrix,
                                          const std::string& name) {
  using Operator = Tpetra::Operator<double, int, GlobalIndex>;
  const RCP<const Operator> inverse = rcp(new GatheredDirect(matrix, name));
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(inverse);
}

}  // namespace lockstep
