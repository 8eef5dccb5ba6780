#pragma once
#include <string>
#include <vector>

#include "linear/near_null_space.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A symmetric positive definite approximate inverse of one block (A or C), chosen by "Type":
///   "Ifpack2", "MueLu"      all other parameters go to that package unchanged; "MueLu" alone means
///                           smoothed aggregation with Chebyshev(2) and a coarse solver that is
///                           right on several ranks; with a near null space,
///                           rigid_motion_multigrid; "Ifpack2" needs its "Prec Type"
///   "Incomplete Cholesky"   without fill, on the overlapping parts of ranks, see
///                           incomplete_cholesky_inverse
///   "Direct"                gathered KLU2
///   "Block Diagonal"        exact inverses of small dense blocks ("Largest Block", 24)
///   "Block Diagonal Mass"   the same of the mass in C = M̃ - dt D, see near_null_space.hpp
///   "Jacobi"                the diagonal
///   "Additive Multilevel"   the same on coarser and coarser aggregates of nodes besides, see
///                           additive_multilevel_inverse
///   "Conjugate Gradients"   inner iteration ("Tolerance", 1e-10; "Maximum Iterations", 1000), with
///                           the inverse that the sublist "Preconditioner" names (Jacobi)
///   "Exact"                 see exact_inverse
/// `name` says what block it is ("pressure block of ..."). Throws InputError for a bad list,
/// SolveError if the block does not allow it (matrix-free, singular, indefinite). Collective.
RCP<const LinearOperator> preconditioner_from_list(const RCP<const LinearOperator>& op,
                                                   const Teuchos::ParameterList& list,
                                                   const std::string& name,
                                                   const NearNullSpace& near_null_space = {});

/// For a soft solid's C in a larger system: an approximate inverse, direct or "MueLu", if dt D
/// outweighs its mass (is_stiff), else null, and the diagonal will do. Collective.
RCP<const LinearOperator> inverse_if_stiff(const RCP<const LinearOperator>& op,
                                           const NearNullSpace& near_null_space,
                                           const std::string& name);

/// Throws InputError unless the list is one that preconditioner_from_list takes. `where` is for
/// messages, and so are the types that the caller takes besides.
void check_preconditioner_list(const Teuchos::ParameterList& list, const std::string& where,
                               const std::vector<std::string>& others = {});

/// Declares a sublist that preconditioner_from_list reads.
void declare_inverse(ParameterList& list, const std::string& name, const std::string& doc);

/// The sublist `name` of `list`, or `standard` if it is absent or
/// empty. Throws InputError if preconditioner_from_list would not take it; `others`: as above.
ParameterList inverse_list(const ParameterList& list, const std::string& name,
                           const ParameterList& standard,
                           const std::vector<std::string>& others = {});

}  // namespace lockstep
