#include "strategies/common/small_dense.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/matrix_rows.hpp"

namespace lockstep {

Eigen::MatrixXd replicated(const CrsMatrix& matrix) {
  std::vector<double> entries;
  for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
    entries.push_back(static_cast<double>(matrix.getRowMap()->getGlobalElement(row)));
    entries.push_back(static_cast<double>(column));
    entries.push_back(value);
  });
  entries = gather_all(matrix.getRowMap()->getComm(), entries);
  const auto n = static_cast<Eigen::Index>(matrix.getGlobalNumRows());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < entries.size(); i += 3)
    dense(static_cast<Eigen::Index>(entries[i]), static_cast<Eigen::Index>(entries[i + 1])) +=
        entries[i + 2];
  return dense;
}

Eigen::VectorXd replicated(const Vector& vector) {
  const auto map = vector.getMap();
  Eigen::VectorXd values =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(map->getGlobalNumElements()));
  const auto mine = vector.getData();
  for (int row = 0; row < static_cast<int>(mine.size()); ++row)
    values[map->getGlobalElement(row)] = mine[row];
  sum_over_ranks(map->getComm(), values);
  return values;
}

void distribute(const Eigen::VectorXd& values, Vector& vector) {
  const auto mine = vector.getDataNonConst();
  for (int row = 0; row < static_cast<int>(mine.size()); ++row)
    mine[row] = values[vector.getMap()->getGlobalElement(row)];
}

}  // namespace lockstep
