#include "linear/matrix_rows.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/row_builder.hpp"

namespace lockstep {

RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& row_map,
                                const std::vector<std::vector<Entry>>& rows,
                                const RCP<const Map>& domain) {
  RowBuilder builder(row_map, domain);
  std::size_t n_entries = 0;
  for (const auto& row : rows)
    n_entries += row.size();
  builder.reserve(n_entries);
  for (const auto& row : rows) {
    for (const Entry& entry : row)
      builder.add(entry.column, entry.value);
    builder.end_row();
  }
  return builder.finish();
}

RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& map,
                                const std::vector<std::vector<Entry>>& rows) {
  return matrix_from_rows(map, rows, map);
}

std::vector<std::vector<Entry>> rows_of(const CrsMatrix& matrix) {
  std::vector<std::vector<Entry>> rows(matrix.getNodeNumRows());
  for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
    rows[row].push_back({column, value});
  });
  return rows;
}

std::vector<int> own_columns(const CrsMatrix& matrix) {
  std::vector<int> columns;
  for (const GlobalIndex id : matrix.getRowMap()->getNodeElementList())
    columns.push_back(matrix.getColMap()->getLocalElement(id));
  return columns;
}

RCP<Vector> diagonal_of(const CrsMatrix& matrix) {
  const auto diagonal = make_vector(matrix.getRowMap());
  matrix.getLocalDiagCopy(*diagonal);
  return diagonal;
}

double round_off_of_sums(const CrsMatrix& coupling_transposed) {
  return 1e-11 * coupling_transposed.getFrobeniusNorm();
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
