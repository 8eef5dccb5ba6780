#include "coupling/stacked_matrix.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "linear/matrix_sum.hpp"

namespace lockstep {

bool all_assembled(const std::vector<StackedPart>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](const StackedPart& part) {
    return !assembled(part.mass).is_null() &&
           (part.implicit_force.is_null() || !assembled(part.implicit_force).is_null());
  });
}

RCP<CrsMatrix> stacked_matrix(const std::vector<StackedPart>& parts, double dt,
                              const RCP<const CrsMatrix>& added, const RCP<const Map>& map,
                              const std::vector<int>& unit_rows) {
  std::vector<Summand> summands;
  for (const StackedPart& part : parts) {
    summands.push_back({assembled(part.mass), part.id_begin, 1});
    if (!part.implicit_force.is_null())
      summands.push_back({assembled(part.implicit_force), part.id_begin, -dt});
  }
  if (!added.is_null())
    summands.push_back({added, 0, 1});
  return sum_of(summands, map, unit_rows);
}

void add_triplets(const CrsMatrix& matrix, GlobalIndex shift, double factor,
                  std::vector<Triplet>& triplets) {
  Teuchos::ArrayView<const int> columns;
  Teuchos::ArrayView<const double> values;
  for (int row = 0; row < static_cast<int>(matrix.getNodeNumRows()); ++row) {
    matrix.getLocalRowView(row, columns, values);
    for (int k = 0; k < columns.size(); ++k) {
      triplets.push_back({matrix.getRowMap()->getGlobalElement(row) + shift,
                          matrix.getColMap()->getGlobalElement(columns[k]) + shift,
                          factor * values[k]});
    }
  }
}

void eliminate_masked(CrsMatrix& matrix, const Vector& mask) {
  matrix.leftScale(mask);
  matrix.rightScale(mask);
  matrix.resumeFill();
  const auto keep = mask.getData();
  for (int row = 0; row < keep.size(); ++row) {
    if (keep[row] != 0)
      continue;
    const GlobalIndex id = matrix.getRowMap()->getGlobalElement(row);
    const double one = 1;
    matrix.replaceGlobalValues(id, Teuchos::arrayView(&id, 1), Teuchos::arrayView(&one, 1));
  }
  matrix.fillComplete();
}

std::vector<Triplet> stacked_triplets(const std::vector<StackedPart>& parts, double dt) {
  std::vector<Triplet> triplets;
  for (const StackedPart& part : parts) {
    add_triplets(*assembled(part.mass), part.id_begin, 1, triplets);
    if (!part.implicit_force.is_null())
      add_triplets(*assembled(part.implicit_force), part.id_begin, -dt, triplets);
  }
  return triplets;
}

}  // namespace lockstep
