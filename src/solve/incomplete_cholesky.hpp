#pragma once
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// Incomplete Cholesky factors without fill (Ifpack2's RILUK(0), which of a symmetric matrix is
/// that) of each rank's rows and of those one entry beyond. With k_i ranks that solve row i and
/// D = diag(1 / k_i):
///   D^1/2 (sum over ranks R^T (L L^T)^-1 R) D^1/2
/// is symmetric positive definite, like the sum alone (additive Schwarz), but does not count rows
/// twice: fewer iterations than the sum, and than parts without overlap. Throws SolveError if
/// Ifpack2 cannot build it; `name` is for messages. Collective.
RCP<const LinearOperator> incomplete_cholesky_inverse(const RCP<const CrsMatrix>& matrix,
                                                      const std::string& name);

}  // namespace lockstep
