#include "linear/matrix_sum.hpp"

#include <Tpetra_CrsMatrix.hpp>

#include "linear/local_rows.hpp"

namespace lockstep {

namespace {

std::vector<GlobalIndex> column_ids(const std::vector<Summand>& summands) {
  std::vector<GlobalIndex> ids;
  for (const Summand& summand : summands) {
    for (const GlobalIndex id : summand.matrix->getColMap()->getNodeElementList())
      ids.push_back(id + summand.shift);
  }
  return ids;
}

/// A summand, with where its rows and columns stand in the sum.
struct Placed {
  const CrsMatrix& matrix;
  double factor;
  std::vector<int> row_of,
      column_of;  ///< by the sum's row: its own or -1; by its column: the sum's
};

Placed placed(const Summand& summand, const LocalColumns& columns) {
  const CrsMatrix& matrix = *summand.matrix;
  Placed result{
      matrix, summand.factor, std::vector<int>(columns.map()->getNodeNumElements(), -1), {}};
  int own = 0;
  for (const GlobalIndex id : matrix.getRowMap()->getNodeElementList())
    result.row_of[columns.map()->getLocalElement(id + summand.shift)] = own++;
  for (const GlobalIndex id : matrix.getColMap()->getNodeElementList())
    result.column_of.push_back(columns.local(id + summand.shift));
  return result;
}

void add_row(const Placed& summand, int row, LocalRows& rows) {
  if (summand.row_of[row] < 0)
    return;
  typename CrsMatrix::local_inds_host_view_type indices;
  typename CrsMatrix::values_host_view_type values;
  summand.matrix.getLocalRowView(summand.row_of[row], indices, values);
  for (std::size_t k = 0; k < indices.extent(0); ++k)
    rows.add(summand.column_of[indices(k)], summand.factor * values(k));
}

}  // namespace

RCP<CrsMatrix> sum_of(const std::vector<Summand>& summands, const RCP<const Map>& map,
                      const std::vector<int>& unit_rows) {
  const LocalColumns columns(map, column_ids(summands));
  std::vector<Placed> parts;
  std::size_t n_entries = unit_rows.size();
  for (const Summand& summand : summands) {
    parts.push_back(placed(summand, columns));
    n_entries += summand.matrix->getNodeNumEntries();
  }
  const int n_rows = static_cast<int>(map->getNodeNumElements());
  std::vector<char> has_unit(n_rows, 0);
  for (const int row : unit_rows)
    has_unit[row] = 1;
  LocalRows rows(columns);
  rows.reserve(n_entries);
  for (int row = 0; row < n_rows; ++row) {
    for (const Placed& part : parts)
      add_row(part, row, rows);
    if (has_unit[row])
      rows.add(row, 1);
    rows.end_row();
  }
  return rows.matrix();
}

}  // namespace lockstep
