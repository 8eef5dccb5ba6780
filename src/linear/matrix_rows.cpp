#include "linear/matrix_rows.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"

namespace lockstep {

RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& row_map,
                                const std::vector<std::vector<Entry>>& rows,
                                const RCP<const Map>& domain, const RCP<const Map>& range) {
  Teuchos::Array<std::size_t> counts(rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    counts[row] = rows[row].size();
  }
  const auto matrix = rcp(new CrsMatrix(row_map, counts()));
  std::vector<GlobalIndex> columns;
  std::vector<double> values;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    columns.clear();
    values.clear();
    for (const Entry& entry : rows[row]) {
      columns.push_back(entry.column);
      values.push_back(entry.value);
    }
    if (!columns.empty())
      matrix->insertGlobalValues(row_map->getGlobalElement(static_cast<int>(row)),
                                 static_cast<int>(columns.size()), values.data(), columns.data());
  }
  matrix->fillComplete(domain, range);
  return matrix;
}

RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& map,
                                const std::vector<std::vector<Entry>>& rows) {
  return matrix_from_rows(map, rows, map, map);
}

std::vector<std::vector<Entry>> rows_of(const CrsMatrix& matrix) {
  std::vector<std::vector<Entry>> rows(matrix.getNodeNumRows());
  for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
    rows[row].push_back({column, value});
  });
  return rows;
}

RCP<Vector> diagonal_of(const CrsMatrix& matrix) {
  const auto diagonal = make_vector(matrix.getRowMap());
  matrix.getLocalDiagCopy(*diagonal);
  return diagonal;
}

RCP<const Map> domain_map(const LinearOperator& op) {
  using Space = Thyra::TpetraVectorSpace<double, int, GlobalIndex, Map::node_type>;
  const auto space = Teuchos::rcp_dynamic_cast<const Space>(op.domain());
  check_input(
      !space.is_null(),
      "The operator \"{}\" has a domain that is not a space of Tpetra vectors; wrap it with "
      "Thyra::createLinearOp.",
      op.description());
  return Thyra::TpetraOperatorVectorExtraction<double, int, GlobalIndex>::getTpetraMap(space);
}

}  // namespace lockstep
