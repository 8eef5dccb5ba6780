#pragma once
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Corners of the elements of one kind, `n_corners` local node numbers each.
struct ElementCorners {
  int n_corners = 0;
  std::vector<int> nodes;
};

/// A sparse matrix of dim x dim blocks over the nodes of this rank: rows are the owned nodes (local
/// numbers 0 .. n_owned - 1), columns all local ones, ghosts included. The pattern is fixed.
template <int dim>
class NodeMatrix {
 public:
  using Block = Eigen::Matrix<double, dim, dim>;
  NodeMatrix() = default;
  /// Every node reaches itself and all nodes it shares an element with.
  NodeMatrix(int n_owned, const std::vector<ElementCorners>& elements);

  int n_rows() const { return static_cast<int>(row_begin_.size()) - 1; }
  int row_begin(int row) const { return row_begin_[row]; }
  int row_end(int row) const { return row_begin_[row + 1]; }
  int column(int entry) const { return columns_[entry]; }  ///< ascending in a row
  const Block& block(int entry) const { return blocks_[entry]; }

  void set_zero();
  /// Adds a row of a matrix with the same pattern: row += factor * other row.
  void add_row(int row, double factor, const NodeMatrix& other);
  void scale_row(int row, double factor);
  /// Product of one row with x (all local nodes).
  Point<dim> row_times(int row, const std::vector<Point<dim>>& x) const;
  /// Rows of ghosts are another rank's: ignored.
  template <typename Derived>
  void add(int row, int column, const Eigen::MatrixBase<Derived>& block) {
    if (row < n_rows())
      blocks_[entry(row, column)] += block;
  }

 private:
  int entry(int row, int column) const;

  std::vector<int> row_begin_{0}, columns_;
  std::vector<Block> blocks_;
};

}  // namespace lockstep
