#include "linear/matrix_sum.hpp"

#include <Tpetra_CrsMatrix.hpp>

#include "linear/row_builder.hpp"

namespace lockstep {

namespace {

/// A summand, with where its rows and columns stand in the sum.
struct Placed {
  const CrsMatrix& matrix;
  double factor;
  std::vector<int> row_of,
      column_of;  ///< by the sum's row: its own or -1; by its column: the builder's
};

Placed placed(const Summand& summand, const Map& map, RowBuilder& rows) {
  const CrsMatrix& matrix = *summand.matrix;
  Placed result{matrix, summand.factor, std::vector<int>(map.getNodeNumElements(), -1), {}};
  int own = 0;
  for (const GlobalIndex id : matrix.getRowMap()->getNodeElementList())
    result.row_of[map.getLocalElement(id + summand.shift)] = own++;
  for (const GlobalIndex id : matrix.getColMap()->getNodeElementList())
    result.column_of.push_back(rows.column(id + summand.shift));
  return result;
}

void add_row(const Placed& summand, int row, RowBuilder& rows) {
  if (summand.row_of[row] < 0)
    return;
  typename CrsMatrix::local_inds_host_view_type indices;
  typename CrsMatrix::values_host_view_type values;
  summand.matrix.getLocalRowView(summand.row_of[row], indices, values);
  for (std::size_t k = 0; k < indices.extent(0); ++k)
    rows.add_at(summand.column_of[indices(k)], summand.factor * values(k));
}

}  // namespace

RCP<CrsMatrix> sum_of(const std::vector<Summand>& summands, const RCP<const Map>& map,
                      const std::vector<int>& unit_rows) {
  RowBuilder rows(map);
  std::vector<Placed> parts;
  std::size_t n_entries = unit_rows.size();
  for (const Summand& summand : summands) {
    parts.push_back(placed(summand, *map, rows));
    n_entries += summand.matrix->getNodeNumEntries();
  }
  const int n_rows = static_cast<int>(map->getNodeNumElements());
  std::vector<char> has_unit(n_rows, 0);
  for (const int row : unit_rows)
    has_unit[row] = 1;
  rows.reserve(n_entries);
  for (int row = 0; row < n_rows; ++row) {
    for (const Placed& part : parts)
      add_row(part, row, rows);
    if (has_unit[row])
      rows.add_at(row, 1);
    rows.end_row();
  }
  return rows.finish();
}

}  // namespace lockstep
