#include "solve/incomplete_cholesky.hpp"

#include <Ifpack2_Factory.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/action_operator.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

namespace {

using RowMatrix = CrsMatrix::row_matrix_type;
using Factors = Ifpack2::Preconditioner<double, CrsMatrix::local_ordinal_type,
                                        CrsMatrix::global_ordinal_type, CrsMatrix::node_type>;

RCP<const Factors> sum_of_overlapping_parts(const RCP<const CrsMatrix>& matrix,
                                            const std::string& name) {
  Teuchos::ParameterList list;
  list.set("schwarz: overlap level", 1);
  list.set("schwarz: combine mode", "ADD");
  list.set("schwarz: use reordering", false);
  list.set("inner preconditioner name", "RILUK");
  list.sublist("inner preconditioner parameters").set("fact: iluk level-of-fill", 0);
  try {
    const auto sum = Ifpack2::Factory().create<RowMatrix>(
        "SCHWARZ", Teuchos::rcp_implicit_cast<const RowMatrix>(matrix));
    sum->setParameters(list);
    sum->initialize();
    sum->compute();
    return sum;
  } catch (const std::exception& error) {
    throw SolveError(fmt::format("Ifpack2 cannot build incomplete Cholesky factors of the {}: {}",
                                 name, library_message(error)));
  }
}

/// D^1/2: a row is in the part of each rank whose rows have an entry in its column.
RCP<Vector> share_of_each_part(const CrsMatrix& matrix) {
  const auto share = make_vector(matrix.getRowMap());
  const auto columns = matrix.getGraph()->getImporter();
  if (!columns.is_null()) {
    Vector ones(matrix.getColMap());
    ones.putScalar(1);
    add_overlap(ones, *columns, *share);
  }
  const auto values = share->getDataNonConst();
  for (double& value : values) {
    value = 1 / std::sqrt(std::max(1.0, value));
  }
  return share;
}

}  // namespace

RCP<const LinearOperator> incomplete_cholesky_inverse(const RCP<const CrsMatrix>& matrix,
                                                      const std::string& name) {
  const auto sum = sum_of_overlapping_parts(matrix, name);
  const auto share = share_of_each_part(*matrix);
  const auto part = make_vector(matrix->getRowMap());
  return action_operator(matrix->getRowMap(), [=](const Vector& residual, Vector& result) {
    part->elementWiseMultiply(1, *share, residual, 0);
    sum->apply(*part, result);
    result.elementWiseMultiply(1, *share, result, 0);
  });
}

}  // namespace lockstep
