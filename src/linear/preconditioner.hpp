#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// A symmetric positive definite approximate inverse of one block (A or C), chosen by "Type":
///   "Ifpack2", "MueLu"      all other parameters go to that package unchanged; "MueLu" alone means
///                           smoothed aggregation with Chebyshev(2) and a coarse solver that is
///                           right on several ranks
///   "Direct"                gathered KLU2
///   "Block Diagonal"        exact inverses of small dense blocks ("Largest Block", 24)
///   "Jacobi"                the diagonal
///   "Conjugate Gradients"   inner iteration ("Tolerance", 1e-10; "Maximum Iterations", 1000)
///   "Exact"                 see exact_inverse
/// `name` says what block it is ("pressure block of ..."). Throws InputError for a bad list,
/// SolveError if the block does not allow it (matrix-free, singular, indefinite). Collective.
RCP<const LinearOperator> preconditioner_from_list(const RCP<const LinearOperator>& op,
                                                   const Teuchos::ParameterList& list,
                                                   const std::string& name);

/// Throws InputError unless the list is one that preconditioner_from_list takes. `where` is for
/// messages.
void check_preconditioner_list(const Teuchos::ParameterList& list, const std::string& where);

}  // namespace lockstep
