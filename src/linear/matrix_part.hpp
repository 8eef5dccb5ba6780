#pragma once
#include <memory>
#include <string>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// The square part of a matrix on some of its rows, numbered anew rank by rank.
class MatrixPart {
 public:
  /// `is_inside` per local row. Collective.
  MatrixPart(const CrsMatrix& matrix, const std::vector<bool>& is_inside);

  const RCP<const Map>& map() const { return map_; }
  const std::vector<int>& rows() const { return rows_; }  ///< local, of the whole matrix
  const RCP<CrsMatrix>& matrix() const { return matrix_; }
  bool empty() const { return map_->getGlobalNumElements() == 0; }

  RCP<Vector> restricted(const Vector& all) const;
  void restrict_to(const Vector& all, Vector& part) const;
  void prolong(const Vector& part, Vector& all) const;  ///< other rows of `all` stay

 private:
  std::vector<int> rows_;
  RCP<const Map> map_;
  RCP<CrsMatrix> matrix_;
};

/// The inverse of a matrix on some of its rows.
struct PartInverse {
  std::shared_ptr<const MatrixPart> part;
  RCP<const LinearOperator> inverse;
};

/// Returns the operator of inverses that act each on its own rows; together these are all rows of
/// `map`. Where two have a row, the later one counts.
RCP<const LinearOperator> inverse_by_parts(const RCP<const Map>& map,
                                           const std::vector<PartInverse>& parts);

/// The inverse of small dense blocks, and of the diagonal where they are not small.
PartInverse part_of_blocks(const std::shared_ptr<const MatrixPart>& part, const std::string& name);

}  // namespace lockstep
