#pragma once
// Common parts of the solvers of peers.cpp.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <array>
#include <ctime>
#include <vector>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// A lattice system as both sides want it.
struct Problem {
  BlockSystem system;
  RCP<const CrsMatrix> matrix;
  RCP<Vector> rhs;
  std::array<int, 3> n{1, 1, 1};
  std::array<bool, 3> periodic{};
  std::vector<std::array<int, 3>> cell_of_row;

  int n_rows() const { return static_cast<int>(cell_of_row.size()); }
  std::size_t place(const std::array<int, 3>& cell) const {
    return cell[0] +
           static_cast<std::size_t>(n[0]) * (cell[1] + static_cast<std::size_t>(n[1]) * cell[2]);
  }
};

struct Outcome {
  int iterations = 0;
  double setup = 1e300, solve = 1e300;  ///< [s]
  RCP<Vector> x;
};

inline double seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Calls f(row, column, value) for the entries of the matrix, by local numbers of rows (one rank
/// has them all).
template <typename Function>
void for_each_entry_of(const Problem& problem, const Function& f) {
  Teuchos::ArrayView<const int> columns;
  Teuchos::ArrayView<const double> values;
  for (int row = 0; row < problem.n_rows(); ++row) {
    problem.matrix->getLocalRowView(row, columns, values);
    for (int i = 0; i < columns.size(); ++i)
      f(row,
        problem.matrix->getRowMap()->getLocalElement(
            problem.matrix->getColMap()->getGlobalElement(columns[i])),
        values[i]);
  }
}

/// 2 axis + end of the face between two neighbours; both ends where two cells meet twice round a
/// period are not told apart.
inline int side_towards(const Problem& problem, int row, int column) {
  for (int axis = 0; axis < 3; ++axis) {
    const int step = problem.cell_of_row[column][axis] - problem.cell_of_row[row][axis];
    if (step != 0)
      return 2 * axis + (step == 1 || step < -1 ? 1 : 0);
  }
  return -1;
}

Outcome pfmg(const Problem& problem, double tolerance);
Outcome boomer_amg(const Problem& problem, double tolerance);

}  // namespace lockstep
