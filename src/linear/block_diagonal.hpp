#pragma once
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// Rows of a dense block that is inverted as one: four times the 6 of a rigid body, for some tied
/// together.
inline constexpr int largest_dense_block = 24;

struct BlockDiagonalInverse {
  RCP<const CrsMatrix> inverse;
  /// True if the inverse is exact: no block was larger than the limit.
  bool exact = false;
};

/// The inverse of a symmetric positive definite matrix that falls apart into small dense blocks (6
/// x 6 of a rigid body): blocks are the connected components of the nonzeros, wherever their rows
/// live. Components of more than `largest_block` rows are replaced by their diagonal. Throws
/// SolveError if a block is not positive definite; `name` is for messages. Collective.
BlockDiagonalInverse block_diagonal_inverse(const RCP<const CrsMatrix>& matrix, int largest_block,
                                            const std::string& name);

/// True if no block of a symmetric matrix, in the sense of `block_diagonal_inverse`, has more than
/// `largest_block` rows; values do not matter. Collective.
bool has_small_blocks(const RCP<const CrsMatrix>& matrix, int largest_block);

/// The sentence for a C = M̃ - dt D without a Cholesky factor; `name` is its name in messages.
std::string not_positive_definite(const std::string& name);

/// Returns one over the diagonal. Throws SolveError if an entry is not positive. Collective.
RCP<Vector> inverse_diagonal(const CrsMatrix& matrix, const std::string& name);
/// Returns the inverse diagonal as a matrix. Throws SolveError if an entry is not positive.
/// Collective.
RCP<const CrsMatrix> jacobi_inverse(const CrsMatrix& matrix, const std::string& name);

}  // namespace lockstep
