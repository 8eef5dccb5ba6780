#include "linear/matrix_part.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/overlap.hpp"
#include "linear/row_builder.hpp"

namespace lockstep {

MatrixPart::MatrixPart(const CrsMatrix& matrix, const std::vector<bool>& is_inside) {
  for (std::size_t row = 0; row < is_inside.size(); ++row) {
    if (is_inside[row])
      rows_.push_back(static_cast<int>(row));
  }
  map_ = make_map(static_cast<int>(rows_.size()), matrix.getComm());
  Vector numbers(matrix.getRowMap());  // integers, which a double holds exactly
  numbers.putScalar(-1);
  {
    const auto values = numbers.getDataNonConst();
    for (std::size_t i = 0; i < rows_.size(); ++i)
      values[rows_[i]] = static_cast<double>(map_->getGlobalElement(static_cast<int>(i)));
  }
  const auto numbers_of_columns = on_columns(matrix, numbers);
  const auto number = numbers_of_columns->getData();
  RowBuilder part(map_);
  std::vector<int> column_of;
  for (const double id : number)
    column_of.push_back(id < 0 ? -1 : part.column(static_cast<GlobalIndex>(id)));
  for (const int row : rows_) {
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    matrix.getLocalRowView(row, indices, values);
    for (std::size_t k = 0; k < indices.extent(0); ++k) {
      if (column_of[indices(k)] >= 0)
        part.add_at(column_of[indices(k)], values(k));
    }
    part.end_row();
  }
  matrix_ = part.finish();
}

RCP<Vector> MatrixPart::restricted(const Vector& all) const {
  const auto part = make_vector(map_);
  restrict_to(all, *part);
  return part;
}

void MatrixPart::restrict_to(const Vector& all, Vector& part) const {
  const auto from = all.getData();
  const auto to = part.getDataNonConst();
  for (std::size_t i = 0; i < rows_.size(); ++i)
    to[i] = from[rows_[i]];
}

void MatrixPart::prolong(const Vector& part, Vector& all) const {
  const auto from = part.getData();
  const auto to = all.getDataNonConst();
  for (std::size_t i = 0; i < rows_.size(); ++i)
    to[rows_[i]] = from[i];
}

RCP<const LinearOperator> inverse_by_parts(const RCP<const Map>& map,
                                           const std::vector<PartInverse>& parts) {
  struct Piece {
    PartInverse of;
    RCP<Vector> x, y;
  };
  std::vector<Piece> pieces;
  for (const PartInverse& part : parts)
    pieces.push_back({part, make_vector(part.part->map()), make_vector(part.part->map())});
  return action_operator(map, [pieces](const Vector& x, Vector& y) {
    for (const Piece& piece : pieces) {
      piece.of.part->restrict_to(x, *piece.x);
      apply(*piece.of.inverse, *piece.x, *piece.y);
      piece.of.part->prolong(*piece.y, y);
    }
  });
}

PartInverse part_of_blocks(const std::shared_ptr<const MatrixPart>& part, const std::string& name) {
  return {part,
          as_operator(block_diagonal_inverse(part->matrix(), largest_dense_block, name).inverse)};
}

}  // namespace lockstep
