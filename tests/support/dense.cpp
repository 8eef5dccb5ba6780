#include "support/dense.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/matrix_rows.hpp"

namespace lockstep::test {
namespace {

/// Sums what every rank knows of a small matrix.
Eigen::MatrixXd summed(Eigen::MatrixXd matrix, const RCP<const Map>& map) {
  const Communicator comm = map->getComm();
  sum_over_ranks(comm, matrix);
  return matrix;
}

Eigen::MatrixXd zeros(const RCP<const Map>& range, const RCP<const Map>& domain) {
  return Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(range->getGlobalNumElements()),
                               static_cast<Eigen::Index>(domain->getGlobalNumElements()));
}

}  // namespace

Eigen::VectorXd dense(const Vector& vector) {
  const RCP<const Map> map = vector.getMap();
  Eigen::VectorXd result =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(map->getGlobalNumElements()));
  const auto values = vector.getData();
  for (int i = 0; i < values.size(); ++i)
    result[map->getGlobalElement(i)] = values[i];
  const Communicator comm = map->getComm();
  sum_over_ranks(comm, result);
  return result;
}

Eigen::MatrixXd dense(const RCP<const LinearOperator>& op) {
  if (!assembled(op).is_null())
    return dense(assembled(op));
  const RCP<const Map> map = domain_map(*op);
  Eigen::MatrixXd result = zeros(map, map);
  for (Eigen::Index k = 0; k < result.cols(); ++k) {
    const auto image = make_vector(map);
    apply(*op, *distributed(Eigen::VectorXd::Unit(result.cols(), k), map), *image);
    result.col(k) = dense(*image);
  }
  return result;
}

Eigen::MatrixXd dense(const RCP<const CrsMatrix>& matrix) {
  Eigen::MatrixXd result = zeros(matrix->getRangeMap(), matrix->getDomainMap());
  for_each_entry(*matrix, [&](int row, GlobalIndex column, double value) {
    result(matrix->getRowMap()->getGlobalElement(row), column) += value;
  });
  return summed(std::move(result), matrix->getRowMap());
}

RCP<Vector> distributed(const Eigen::VectorXd& values, const RCP<const Map>& map) {
  const auto result = make_vector(map);
  for (GlobalIndex id : map->getNodeElementList())
    result->replaceGlobalValue(id, values[id]);
  return result;
}

}  // namespace lockstep::test
