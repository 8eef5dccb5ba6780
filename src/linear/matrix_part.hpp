#pragma once
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
  const RCP<CrsMatrix>& matrix() const { return matrix_; }
  bool empty() const { return map_->getGlobalNumElements() == 0; }

  RCP<Vector> restricted(const Vector& all) const;
  void prolong(const Vector& part, Vector& all) const;  ///< other rows of `all` stay

 private:
  std::vector<int> rows_;
  RCP<const Map> map_;
  RCP<CrsMatrix> matrix_;
};

/// diag(of_inside on the rows of `inside`, the inverse of small dense blocks or of the diagonal on
/// those of `outside`); together they are all rows of `map`. Collective.
RCP<const LinearOperator> inverse_by_parts(const MatrixPart& inside,
                                           const RCP<const LinearOperator>& of_inside,
                                           const MatrixPart& outside, const RCP<const Map>& map,
                                           const std::string& name);

}  // namespace lockstep
