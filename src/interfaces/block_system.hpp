#pragma once
#include <string>
#include <vector>

#include "linear/near_null_space.hpp"
#include "linear/null_space.hpp"

namespace Thyra {
template <typename Scalar>
class PhysicallyBlockedLinearOpBase;
}

namespace lockstep {

using BlockedOperator = Thyra::PhysicallyBlockedLinearOpBase<double>;

/// The unknowns of one name: local rows from `begin` to before `end` in the vectors of their group.
struct Block {
  std::string name;
  int begin = 0, end = 0;
};

/// Blocks of the same kind, which follow one another in one vector and are solved for as one.
struct BlockGroup {
  std::vector<Block> blocks = {};  ///< by name; empty: the group has no names within
  long version = 0;                ///< changes whenever the group's operator changes
};

/// The coupled system, Eq. 16, as one Thyra operator of blocks in two groups:
///
///   [  A    -B ] [ p̂   ]   [  pressure rhs ]
///   [ -B^T  -C ] [ V_S ] = [ -solid rhs    ]
///
/// with A = V G_f^T rho^-1 G_f, B = V G_c^T W, C = M̃_S - dt D. A and C are symmetric and, but for
/// null vectors, positive definite. Without (dynamic) solids the operator is [ A ] alone.
class BlockSystem {
 public:
  /// Sets the operator from its blocks, which are shared, not copied: A, B^T (solid dofs x pressure
  /// unknowns, on the maps of C and A; B is never stored, its block is the adjoint) and C. The last
  /// two go together. Collective.
  void set_blocks(const RCP<const LinearOperator>& pressure_block,
                  const RCP<const CrsMatrix>& coupling_transposed = Teuchos::null,
                  const RCP<const LinearOperator>& solid_block = Teuchos::null);

  /// [A, -B; -B^T, -C] or [A]; null before `set_blocks`. What solvers from lists are given.
  const RCP<const BlockedOperator>& op() const { return op_; }
  /// Blocks of the operator without their signs, for solvers that look inside. The last two are
  /// null without solids.
  const RCP<const LinearOperator>& pressure_block() const { return pressure_block_; }       ///< A
  const RCP<const CrsMatrix>& coupling_transposed() const { return coupling_transposed_; }  ///< B^T
  const RCP<const LinearOperator>& solid_block() const { return solid_block_; }             ///< C
  bool has_solid() const { return !solid_block_.is_null(); }

  BlockGroup solids;              ///< the unknowns of C
  NearNullSpace near_null_space;  ///< in the rows of C; empty without soft solids
  /// Orthonormal basis of the null space over (p̂, V_S = 0); empty for a regular system.
  NullSpace null_space;
  /// Null vectors of A alone (regions without a Dirichlet face), for preconditioners. Orthonormal.
  NullSpace pressure_null_space;
  std::string name = "coupled system";
  long geometry_version = 0;  ///< changes whenever A, B or the maps change

 private:
  RCP<const BlockedOperator> op_;
  RCP<const LinearOperator> pressure_block_, solid_block_;
  RCP<const CrsMatrix> coupling_transposed_;
};

/// A right-hand side or solution of the block system, a vector a group. `solid` is null when the
/// system has no solid.
struct BlockVector {
  RCP<Vector> pressure;
  RCP<Vector> solid;
};

}  // namespace lockstep
