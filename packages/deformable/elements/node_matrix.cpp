#include "deformable/elements/node_matrix.hpp"

#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
NodeMatrix<dim>::NodeMatrix(int n_owned, const std::vector<ElementCorners>& elements) {
  std::vector<std::vector<int>> rows(n_owned);
  for (int i = 0; i < n_owned; ++i)
    rows[i].push_back(i);
  for (const ElementCorners& kind : elements) {
    for (std::size_t e = 0; e < kind.nodes.size(); e += kind.n_corners) {
      for (int i = 0; i < kind.n_corners; ++i) {
        const int row = kind.nodes[e + i];
        if (row < n_owned)
          rows[row].insert(rows[row].end(), &kind.nodes[e], &kind.nodes[e] + kind.n_corners);
      }
    }
  }
  for (auto& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    row_begin_.push_back(static_cast<int>(columns_.size()));
  }
  blocks_.assign(columns_.size(), Block::Zero());
}

template <int dim>
void NodeMatrix<dim>::set_zero() {
  std::fill(blocks_.begin(), blocks_.end(), Block::Zero());
}

template <int dim>
void NodeMatrix<dim>::add_row(int row, double factor, const NodeMatrix& other) {
  for (int k = row_begin(row); k < row_end(row); ++k)
    blocks_[k] += factor * other.blocks_[k];
}

template <int dim>
void NodeMatrix<dim>::scale_row(int row, double factor) {
  for (int k = row_begin(row); k < row_end(row); ++k)
    blocks_[k] *= factor;
}

template <int dim>
Point<dim> NodeMatrix<dim>::row_times(int row, const std::vector<Point<dim>>& x) const {
  Point<dim> sum = Point<dim>::Zero();
  for (int k = row_begin(row); k < row_end(row); ++k)
    sum += blocks_[k] * x[columns_[k]];
  return sum;
}

template <int dim>
int NodeMatrix<dim>::entry(int row, int column) const {
  const auto begin = columns_.begin() + row_begin_[row],
             end = columns_.begin() + row_begin_[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  LOCKSTEP_ASSERT(found != end && *found == column);
  return static_cast<int>(found - columns_.begin());
}

template class NodeMatrix<2>;
template class NodeMatrix<3>;

}  // namespace lockstep
