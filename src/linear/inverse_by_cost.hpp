#pragma once
#include <memory>
#include <string>
#include <vector>

#include "linear/matrix_part.hpp"
#include "linear/near_null_space.hpp"

namespace lockstep {

/// The inverse of a symmetric positive definite C, component by component of its nonzeros: exact
/// where that is cheap (dense blocks for the 6 x 6 of rigid bodies, sparse Cholesky factors for
/// cloths and small volumes), while the rest is left to an iteration, which then need not suffer
/// from what the others are like.
class InverseByCost {
 public:
  /// `name` is for messages. Throws SolveError if C is not positive definite. Collective.
  InverseByCost(const RCP<const LinearOperator>& op, const std::string& name);

  /// Nothing is left: `with` needs no inverse of the rest.
  bool is_complete() const { return rest_.is_null(); }
  /// What is left, on rows of its own; C itself if nothing was cheap. Null if `is_complete`.
  const RCP<const LinearOperator>& rest() const { return rest_; }
  /// The rigid motions of bodies in it.
  NearNullSpace of_rest(const NearNullSpace& all) const;

  /// C^-1 with this inverse of `rest`, on the rows of C. Applying it is collective.
  RCP<const LinearOperator> with(const RCP<const LinearOperator>& of_rest) const;

 private:
  void split(const RCP<const CrsMatrix>& matrix, const std::string& name);

  RCP<const Map> map_;
  RCP<const LinearOperator> whole_;  ///< C^-1, if one method serves all of it
  std::vector<PartInverse> cheap_;
  std::shared_ptr<const MatrixPart> rest_part_;  ///< null: all rows
  RCP<const LinearOperator> rest_;
};

}  // namespace lockstep
