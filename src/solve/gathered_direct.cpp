#include "solve/gathered_direct.hpp"

#include <Amesos2.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/gathered_operator.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

struct Factorisation {
  RCP<CrsMatrix> matrix;
  RCP<MultiVector> rhs, solution;
  RCP<Amesos2::Solver<CrsMatrix, MultiVector>> solver;
};

SolveInPlace factor(const CrsMatrix& gathered) {
  const auto factors = std::make_shared<Factorisation>();
  const auto serial =
      rcp(new Map(gathered.getGlobalNumRows(), 0, Communicator(rcp(new Teuchos::SerialComm<int>))));
  factors->matrix = matrix_from_rows(serial, rows_of(gathered));
  factors->rhs = rcp(new MultiVector(serial, 1));
  factors->solution = rcp(new MultiVector(serial, 1));
  factors->solver = Amesos2::create<CrsMatrix, MultiVector>("KLU2", factors->matrix,
                                                            factors->solution, factors->rhs);
  factors->solver->symbolicFactorization().numericFactorization();
  return [factors](double* values) {
    const std::size_t n = factors->matrix->getNodeNumRows();
    std::copy_n(values, n, factors->rhs->getDataNonConst(0).begin());
    factors->solver->solve();
    std::copy_n(factors->solution->getData(0).begin(), n, values);
  };
}

}  // namespace

RCP<const LinearOperator> gathered_direct(const RCP<const CrsMatrix>& matrix,
                                          const std::string& name) {
  return gathered_operator(
      matrix, factor,
      fmt::format("The direct solver cannot factor the {} ({} unknowns): the matrix is singular or "
                  "not finite. Check that every region of fluid without an open side is among the "
                  "null vectors. KLU2 says:",
                  name, matrix->getGlobalNumRows()));
}

}  // namespace lockstep
