#pragma once
#include <cstddef>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Calls `visit(local row, global column, value)` for every stored entry of this rank's rows.
template <typename Visit>
void for_each_entry(const CrsMatrix& matrix, Visit visit) {
  const auto columns = matrix.getColMap();
  for (int row = 0; row < static_cast<int>(matrix.getNodeNumRows()); ++row) {
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    matrix.getLocalRowView(row, indices, values);
    for (std::size_t k = 0; k < indices.extent(0); ++k) {
      visit(row, columns->getGlobalElement(indices(k)), values(k));
    }
  }
}

/// One entry of a matrix row.
struct Entry {
  GlobalIndex column;
  double value;
};

/// A matrix from this rank's rows, in the order of `row_map`, by a RowBuilder. Collective.
RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& row_map,
                                const std::vector<std::vector<Entry>>& rows,
                                const RCP<const Map>& domain_map);
/// The square case.
RCP<CrsMatrix> matrix_from_rows(const RCP<const Map>& map,
                                const std::vector<std::vector<Entry>>& rows);

/// This rank's rows as lists.
std::vector<std::vector<Entry>> rows_of(const CrsMatrix& matrix);

/// By local row of a square matrix the local column of the same number, -1 if it stores none.
std::vector<int> own_columns(const CrsMatrix& matrix);

/// The diagonal of a square matrix. Collective.
RCP<Vector> diagonal_of(const CrsMatrix& matrix);

/// Bound of the round-off in an entry, or in a combination of columns, of this coupling matrix
/// where the terms that make it cancel. Collective.
double round_off_of_sums(const CrsMatrix& coupling_transposed);

/// The map behind an operator's domain. Throws InputError if the space is not Tpetra's.
RCP<const Map> domain_map(const LinearOperator& op);

}  // namespace lockstep
