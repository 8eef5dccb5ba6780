#pragma once
#include <string>
#include <vector>

#include "linear/null_space.hpp"
#include "linear/soft_nodes.hpp"

namespace lockstep {

/// The unknowns of one name: local rows from `begin` to before `end` in the vectors of their group.
struct Block {
  std::string name;
  int begin = 0, end = 0;
};

/// Blocks of the same kind, which follow one another in one vector and are solved for as one; an
/// operator between two of them is part of `op`.
struct BlockGroup {
  std::string name;                ///< for messages
  RCP<const LinearOperator> op;    ///< symmetric, positive definite but for null vectors
  std::vector<Block> blocks = {};  ///< by name; empty: the group has no names within
  long stamp = 0;                  ///< changes whenever `op` changes
};

/// The coupled system, Eq. 16, as named blocks in two groups:
///
///   [  A    -B ] [ p̂   ]   [  pressure rhs ]
///   [ -B^T  -C ] [ V_S ] = [ -solid rhs    ]
///
/// with A = V G_f^T rho^-1 G_f, B = V G_c^T W, C = M̃_S - dt D (SPD). There may be no solids (no
/// dynamic ones): then `solids.op` and `coupling_transposed` are null and the system is A p̂ = rhs.
struct BlockSystem {
  BlockGroup pressure{"pressure block", {}};  ///< A
  BlockGroup solids{"solid block", {}};       ///< C
  /// B^T, solid dofs x pressure unknowns. B is never stored.
  RCP<const CrsMatrix> coupling_transposed;
  SoftNodes soft_nodes;  ///< in the rows of C; empty without soft solids
  /// Orthonormal basis of the null space over (p̂, V_S = 0); empty for a regular system.
  NullSpace null_space;
  /// Null vectors of A alone (regions without a Dirichlet face), for preconditioners. Orthonormal.
  NullSpace pressure_null_space;
  std::string name = "coupled system";
  long geometry_stamp = 0;  ///< changes whenever A, B or the maps change

  bool has_solid() const { return !solids.op.is_null(); }
};

/// A right-hand side or solution of the block system, a vector a group. `solid` is null when the
/// system has no solid.
struct BlockVector {
  RCP<Vector> pressure;
  RCP<Vector> solid;
};

}  // namespace lockstep
