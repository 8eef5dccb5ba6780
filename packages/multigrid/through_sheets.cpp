#include "multigrid/through_sheets.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "linear/matrix_rows.hpp"
#include "linear/near_null_space.hpp"
#include "linear/overlap.hpp"
#include "multigrid/lattice_layout.hpp"

namespace lockstep {

namespace {

/// An entry of a node's row of B^T, by where its cell lies: its line along the node's axis, and its
/// place on the line.
struct Touched {
  long line = 0;
  int place = 0;
  double value = 0;
  int column = 0;
};

/// A face between two cells of a line: the upper cell's column, and |b_f|.
struct TouchedFace {
  int upper = 0;
  double weight = 0;
};

/// The faces whose differences of pressures make up a row; none if the row does not cancel along
/// its lines, that is, if the fluid is on one side only.
std::vector<TouchedFace> faces_of(std::vector<Touched>& row) {
  std::sort(row.begin(), row.end(), [](const Touched& a, const Touched& b) {
    return a.line != b.line ? a.line < b.line : a.place < b.place;
  });
  double largest = 0;
  for (const Touched& entry : row)
    largest = std::max(largest, std::abs(entry.value));
  const double round_off = 1e-8 * largest;
  std::vector<TouchedFace> faces;
  double sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (std::abs(sum) > round_off) {
      if (row[i].line != row[i - 1].line || row[i].place != row[i - 1].place + 1)
        return {};
      faces.push_back({row[i].column, std::abs(sum)});
    }
    sum += row[i].value;
  }
  return std::abs(sum) > round_off ? std::vector<TouchedFace>() : faces;
}

/// The lattice's number of the cell of every local row; -1 for the rows to leave alone.
RCP<Vector> cell_numbers(const FaceCoefficients& coefficients, const std::vector<int>& empty_rows) {
  const auto& n = coefficients.blocks->n_cells;
  const auto result = make_vector(coefficients.map);
  const auto values = result->getDataNonConst();
  for_each_cell(*coefficients.blocks, [&](std::size_t cell, const std::array<int, 3>& at) {
    if (coefficients.row[cell] >= 0)
      values[coefficients.row[cell]] =
          at[0] + static_cast<double>(n[0]) * (at[1] + static_cast<double>(n[1]) * at[2]);
  });
  for (const int row : empty_rows)
    values[row] = -1;
  return result;
}

/// The axis that a node's row of C belongs to; -1: no node's.
std::vector<int> axes_of_rows(const NearNullSpace& space) {
  std::vector<int> axes(space.body_of_row.size(), -1);
  for (int axis = 0; axis < space.n_axes(); ++axis) {
    const auto translation = space.motions->getData(axis);
    for (std::size_t row = 0; row < axes.size(); ++row) {
      if (translation[row] != 0)
        axes[row] = axis;
    }
  }
  return axes;
}

/// Cloth has up to 100, the nodes of a thick flag of FSI1 10^6, and with them the preconditioner
/// took four times the iterations; in between it makes no difference. Per unit of the node's mass.
constexpr double stiffest_sheet = 1000;

/// The softest direction of a node's own block in a matrix. Across a cloth that is little, whatever
/// its elasticity; inside a volume it is much.
class SoftestDirections {
 public:
  SoftestDirections(const CrsMatrix& c, const std::vector<int>& axes)
      : c_(c), axes_(axes), row_of_(c.getColMap()->getNodeNumElements(), -1), least_(axes.size()) {
    const std::vector<int> columns = own_columns(c);
    for (std::size_t row = 0; row < columns.size(); ++row) {
      if (columns[row] >= 0)
        row_of_[columns[row]] = static_cast<int>(row);
    }
  }

  /// The least eigenvalue of the block of the row's node.
  double of_row(int row) {
    const int first = row - axes_[row];
    if (!least_[first])
      least_[first] = of_node(first);
    return *least_[first];
  }

 private:
  double of_node(int first) const {
    int n_axes = 1;
    while (first + n_axes < static_cast<int>(axes_.size()) && axes_[first + n_axes] == n_axes)
      ++n_axes;
    CrsMatrix::local_inds_host_view_type columns;
    CrsMatrix::values_host_view_type values;
    using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
    Block block = Block::Zero(n_axes, n_axes);
    for (int a = 0; a < n_axes; ++a) {
      c_.getLocalRowView(first + a, columns, values);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const int b = row_of_[columns(k)] - first;
        if (b >= 0 && b < n_axes)
          block(a, b) += values(k);
      }
    }
    return Eigen::SelfAdjointEigenSolver<Block>(block, Eigen::EigenvaluesOnly).eigenvalues()[0];
  }

  const CrsMatrix& c_;
  const std::vector<int>& axes_;
  std::vector<int> row_of_;                   ///< by local column, -1: another rank's
  std::vector<std::optional<double>> least_;  ///< by a node's first row
};

/// The entries of each node's row, by where their cells lie.
std::vector<std::vector<Touched>> touched_cells(const CrsMatrix& coupling,
                                                const std::vector<int>& axes, const Vector& numbers,
                                                const std::array<int, 3>& n_cells) {
  std::vector<std::vector<Touched>> rows(axes.size());
  const std::array<long, 3> stride{1, n_cells[0], static_cast<long>(n_cells[0]) * n_cells[1]};
  const auto number = numbers.getData();
  CrsMatrix::local_inds_host_view_type columns;
  CrsMatrix::values_host_view_type values;
  for (int row = 0; row < static_cast<int>(rows.size()); ++row) {
    const int axis = axes[row];
    if (axis < 0)
      continue;
    coupling.getLocalRowView(row, columns, values);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (values(k) == 0)
        continue;
      // Cells to be left alone stand on lines of their own, where nothing cancels.
      const int column = columns(k);
      const long cell = static_cast<long>(number[column]);
      const int place = cell < 0 ? 0 : static_cast<int>(cell / stride[axis] % n_cells[axis]);
      const long line = cell < 0 ? -1 - column : cell - place * stride[axis];
      rows[row].push_back({line, place, values(k), column});
    }
  }
  return rows;
}

/// b_f sum_g b_g / m by axis of the face, on the columns of B^T that are its upper cell.
MultiVector conductances(const BlockSystem& system, const Vector& numbers,
                         const std::array<int, 3>& n_cells) {
  const CrsMatrix& coupling = *system.coupling_transposed();
  const std::vector<int> axes = axes_of_rows(system.near_null_space);
  std::vector<std::vector<Touched>> rows = touched_cells(coupling, axes, numbers, n_cells);
  const auto solid_block = assembled(system.solid_block());
  SoftestDirections softest(*solid_block, axes);
  const auto masses = system.near_null_space.mass->getData();
  MultiVector result(coupling.getColMap(), system.near_null_space.n_axes());
  std::vector<Teuchos::ArrayRCP<double>> by_axis;
  for (int axis = 0; axis < system.near_null_space.n_axes(); ++axis)
    by_axis.push_back(result.getDataNonConst(axis));
  for (int row = 0; row < static_cast<int>(rows.size()); ++row) {
    if (rows[row].empty() || !(masses[row] > 0))
      continue;
    const std::vector<TouchedFace> faces = faces_of(rows[row]);
    if (faces.empty() || softest.of_row(row) > stiffest_sheet * masses[row])
      continue;
    double sum = 0;
    for (const TouchedFace& face : faces)
      sum += face.weight;
    for (const TouchedFace& face : faces)
      by_axis[axes[row]][face.upper] += face.weight * sum / masses[row];
  }
  return result;
}

}  // namespace

std::optional<FaceCoefficients> conducting_through_sheets(const BlockSystem& system,
                                                          const std::vector<int>& empty_rows) {
  if (!system.has_solid() || system.near_null_space.empty() ||
      assembled(system.solid_block()).is_null())
    return {};
  const FaceCoefficients& a = *stencil_of(system.pressure_block());
  const CrsMatrix& coupling = *system.coupling_transposed();
  const auto importer = coupling.getGraph()->getImporter();
  const RCP<Vector> by_row = cell_numbers(a, empty_rows);
  const MultiVector by_face =
      conductances(system, *on_columns(coupling, *by_row), a.blocks->n_cells);
  std::vector<double> largest(by_face.getNumVectors());
  by_face.normInf(Teuchos::arrayViewFromVector(largest));
  if (*std::max_element(largest.begin(), largest.end()) == 0)
    return {};
  MultiVector added(a.map, by_face.getNumVectors());
  if (importer.is_null())
    added.update(1, by_face, 0);
  else
    added.doExport(by_face, *importer, Tpetra::ADD);

  // Rounded: the sums over nodes come in another order on other numbers of ranks.
  constexpr double steps = 1 << 12;
  FaceCoefficients result = a;
  for (std::size_t axis = 0; axis < added.getNumVectors(); ++axis) {
    const auto values = added.getData(axis);
    for (std::size_t cell = 0; cell < a.row.size(); ++cell) {
      const double value = a.row[cell] < 0 ? 0 : values[a.row[cell]];
      if (value != 0)
        result.lower[axis][cell] += static_cast<float>(std::round(steps * value / a.unit) / steps);
    }
  }
  return result;
}

}  // namespace lockstep
