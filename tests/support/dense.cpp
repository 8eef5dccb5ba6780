#include "support/dense.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/matrix_rows.hpp"

namespace lockstep::testing {
namespace {

template <typename Apply>
Eigen::MatrixXd columns_of(const RCP<const Map>& domain, const RCP<const Map>& range, Apply apply) {
  const int n = static_cast<int>(domain->getGlobalNumElements());
  Eigen::MatrixXd result(static_cast<Eigen::Index>(range->getGlobalNumElements()), n);
  for (int k = 0; k < n; ++k) {
    const auto image = make_vector(range);
    apply(*distributed(Eigen::VectorXd::Unit(n, k), domain), *image);
    result.col(k) = dense(*image);
  }
  return result;
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
  sum_all(comm, result.data(), static_cast<int>(result.size()));
  return result;
}

Eigen::MatrixXd dense(const LinearOperator& op) {
  const RCP<const Map> map = domain_map(op);
  return columns_of(map, map, [&](const Vector& x, Vector& y) { apply(op, x, y); });
}

Eigen::MatrixXd dense(const RCP<const CrsMatrix>& matrix) {
  return columns_of(matrix->getDomainMap(), matrix->getRangeMap(),
                    [&](const Vector& x, Vector& y) { matrix->apply(x, y); });
}

RCP<Vector> distributed(const Eigen::VectorXd& values, const RCP<const Map>& map) {
  const auto result = make_vector(map);
  for (GlobalIndex id : map->getNodeElementList())
    result->replaceGlobalValue(id, values[id]);
  return result;
}

}  // namespace lockstep::testing
