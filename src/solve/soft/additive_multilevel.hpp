#pragma once
#include <string>

#include "linear/near_null_space.hpp"

namespace lockstep {

/// For a soft solid's C = M̃ - dt D the sum over levels of Q_l diag(Q_l^T C Q_l)^-1 Q_l^T (Bramble,
/// Pasciak and Xu 1990): Q_0 = 1, the others are the translations of aggregates, a node and its
/// neighbours, then an aggregate and its neighbours, and so on; on the last and smallest level the
/// inverse is exact (on rank 0). Symmetric positive definite. Conjugate gradients need about half
/// as many iterations as with the diagonal alone where D matters, at hardly more each; no
/// rotations, so it does not last when D dominates (see rigid_motion_multigrid). Nodes are those of
/// `space`; aggregates do not cross ranks. Without nodes the diagonal alone. `name` is for
/// messages. Throws SolveError if C is not positive definite. Collective.
RCP<const LinearOperator> additive_multilevel_inverse(const RCP<const CrsMatrix>& c,
                                                      const NearNullSpace& space,
                                                      const std::string& name);

}  // namespace lockstep
