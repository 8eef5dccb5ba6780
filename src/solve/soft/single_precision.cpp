#include "solve/soft/single_precision.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "linear/action_operator.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// Blocks of this rank's rows, row after row, each in the order of its columns. A row of blocks
/// holds those that have an entry.
template <int block>
class NodeBlocks {
 public:
  explicit NodeBlocks(const RCP<const CrsMatrix>& matrix);

  bool pays() const {
    const double n_places = static_cast<double>(columns_.size()) * block * block;
    return n_entries_ > 0.6 * n_places;
  }
  void apply(const Vector& x, Vector& y) const;

 private:
  void add_row_of_blocks(int row);
  void multiply(const double* x, double* y) const;

  RCP<const CrsMatrix> matrix_;     ///< whose import is used
  RCP<Vector> on_columns_;          ///< x with what other ranks own; null: x itself
  std::vector<std::size_t> begin_;  ///< first block of each row
  std::vector<int> columns_;        ///< columns of the blocks
  std::vector<float> values_;       ///< column by column; one beyond the last may be read
  std::vector<int> place_;          ///< while building: by column of blocks
  std::size_t n_entries_ = 0;
};

template <int block>
NodeBlocks<block>::NodeBlocks(const RCP<const CrsMatrix>& matrix)
    : matrix_(matrix), place_(matrix->getColMap()->getNodeNumElements() / block, -1) {
  if (!matrix->getGraph()->getImporter().is_null())
    on_columns_ = rcp(new Vector(matrix->getColMap()));
  begin_.push_back(0);
  for (int row = 0; row < static_cast<int>(matrix->getNodeNumRows()); row += block) {
    add_row_of_blocks(row);
    begin_.push_back(columns_.size());
  }
  values_.push_back(0);
  std::vector<int>().swap(place_);
}

template <int block>
void NodeBlocks<block>::add_row_of_blocks(int row) {
  for (int a = 0; a < block; ++a) {
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    matrix_->getLocalRowView(row + a, indices, values);
    n_entries_ += indices.extent(0);
    for (std::size_t k = 0; k < indices.extent(0); ++k) {
      int& place = place_[indices(k) / block];
      if (place < 0) {
        place = static_cast<int>(columns_.size());
        columns_.push_back(indices(k) / block);
        values_.resize(values_.size() + block * block);
      }
      values_[static_cast<std::size_t>(place) * block * block + indices(k) % block * block + a] =
          static_cast<float>(values(k));
    }
  }
  for (std::size_t k = begin_.back(); k < columns_.size(); ++k)
    place_[columns_[k]] = -1;
}

template <int block>
void NodeBlocks<block>::multiply(const double* x, double* y) const {
  constexpr int n_lanes = block == 3 ? 4 : block;  // the fourth belongs to the next column
  const int n_rows = static_cast<int>(begin_.size()) - 1;
  const float* value = values_.data();
  for (int row = 0; row < n_rows; ++row) {
    std::array<std::array<double, n_lanes>, block> sums{};
    for (std::size_t k = begin_[row]; k < begin_[row + 1]; ++k, value += block * block) {
      const double* of_column = x + static_cast<std::ptrdiff_t>(columns_[k]) * block;
      for (int b = 0; b < block; ++b) {
        for (int lane = 0; lane < n_lanes; ++lane)
          sums[b][lane] += static_cast<double>(value[b * block + lane]) * of_column[b];
      }
    }
    for (int a = 0; a < block; ++a) {
      double sum = 0;
      for (int b = 0; b < block; ++b)
        sum += sums[b][a];
      y[row * block + a] = sum;
    }
  }
}

template <int block>
void NodeBlocks<block>::apply(const Vector& x, Vector& y) const {
  if (!on_columns_.is_null())
    on_columns_->doImport(x, *matrix_->getGraph()->getImporter(), Tpetra::INSERT);
  const auto given = on_columns_.is_null() ? x.getData() : on_columns_->getData();
  const auto result = y.getDataNonConst();
  multiply(given.getRawPtr(), result.getRawPtr());
}

template <int block>
RCP<const LinearOperator> copy_in_blocks(const RCP<const CrsMatrix>& matrix) {
  const auto fits = [](const Map& map) { return map.getNodeNumElements() % block == 0; };
  const Communicator comm = matrix->getComm();
  if (max_all(comm, fits(*matrix->getRowMap()) && fits(*matrix->getColMap()) ? 0.0 : 1.0) > 0)
    return Teuchos::null;
  const auto copy = std::make_shared<const NodeBlocks<block>>(matrix);
  if (max_all(comm, copy->pays() || matrix->getNodeNumRows() == 0 ? 0.0 : 1.0) > 0)
    return Teuchos::null;
  return action_operator(matrix->getRowMap(),
                         [copy](const Vector& x, Vector& y) { copy->apply(x, y); });
}

/// Largest ratio C_ii / mass of the nodes' rows [1]. Collective.
double largest_stiffness(const CrsMatrix& c, const NearNullSpace& space) {
  const RCP<const Vector> diagonal = diagonal_of(c);
  const auto mass = space.mass->getData(), entry = diagonal->getData();
  double largest = 0;
  for (std::size_t row = 0; row < space.body_of_row.size(); ++row) {
    if (space.body_of_row[row] >= 0)
      largest = std::max(largest, mass[row] > 0 ? entry[row] / mass[row] : 1e300);
  }
  return max_all(c.getComm(), largest);
}

}  // namespace

RCP<const LinearOperator> single_precision_copy(const RCP<const CrsMatrix>& c,
                                                const NearNullSpace& space) {
  constexpr double most_stiffness = 1e4;
  if (space.empty() || largest_stiffness(*c, space) > most_stiffness)
    return Teuchos::null;
  return space.n_axes() == 3 ? copy_in_blocks<3>(c) : copy_in_blocks<2>(c);
}

}  // namespace lockstep
