#pragma once
#include <string>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// The rigid motions of soft solids, which cost no elastic energy: the near null space of dt D.
struct RigidMotions {
  /// One column a motion on the rows of C: the translations along the axes, then the rotations
  /// (3 columns in 2D, 6 in 3D). Null: no soft solids. Rows that are no node's are zero; those of a
  /// node follow one another.
  RCP<const MultiVector> motions;
  /// Body of each local row; -1: not the row of a node (rigid bodies, padding).
  std::vector<int> body_of_row;
  int n_bodies = 0;  ///< on all ranks

  bool empty() const { return motions.is_null(); }
  int n_axes() const { return motions->getNumVectors() == 3 ? 2 : 3; }
};

/// Rigid motions and masses of the nodes of soft solids, of which inverses of C = M̃ - dt D make
/// their near null space; the mass tells M̃ and dt D apart.
struct NearNullSpace : RigidMotions {
  /// M̃ of the nodes' rows, lumped (`lumped_mass`); 1 in the rows of held nodes, as in C; other
  /// rows
  /// 0 [kg]. It cannot be computed from C, whose rows beside held nodes do not sum to M̃. Null: no
  /// motions.
  RCP<const Vector> mass;
};

/// Returns for each node the local row of its first axis; the other axes follow.
std::vector<int> first_rows_of_nodes(const RigidMotions& space);

/// Ratio of stiffness to mass of the soft solids in this step: trace(C) / trace(M̃) over the nodes'
/// rows that are not held. If none is held, it is the reciprocal of a Rayleigh quotient of
/// diag(C)^-1 C, whose condition number it bounds from below. 1 where D = 0. Collective.
double stiffness_number(const CrsMatrix& c, const NearNullSpace& space);
/// True if dt D outweighs M̃ so far that a multigrid cycle is worth its price, which is that of ten
/// iterations with the diagonal: a stiffness number of 150 or more (measured on a ball of 8 000
/// nodes, where both take as long at 200).
bool is_stiff(double stiffness_number);

/// The sums of the nodes' rows of M̃ along their axes, by one product with each translation of
/// `space`; other rows 0 [kg]. Collective.
RCP<Vector> lumped_mass(const LinearOperator& mass, const RigidMotions& space);

/// The inverse of the lumped mass on the nodes' rows, and of dense blocks on the others: the
/// paper's block-diagonal mass, which knows nothing of D. Throws SolveError where a mass is not
/// positive. Collective.
RCP<const LinearOperator> block_diagonal_mass_inverse(const RCP<const CrsMatrix>& c,
                                                      const NearNullSpace& space,
                                                      const std::string& name);

}  // namespace lockstep
