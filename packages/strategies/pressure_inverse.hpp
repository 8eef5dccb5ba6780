#pragma once
#include <Teuchos_ParameterList.hpp>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// The approximate inverse of A that a list names (see linear/preconditioner.hpp), made positive
/// definite where A is not:
/// - a cell all of whose faces are mixed has an empty row in A; its diagonal becomes that of
///   B diag(C)^-1 B^T;
/// - with "Ifpack2" and "Direct", which factor, the first cell of each null vector of A alone is
///   pinned by adding its diagonal once more. Multigrid and Jacobi take a singular A.
/// Throws InputError for a bad list, SolveError if the set-up fails. Collective.
RCP<const LinearOperator> pressure_inverse(const BlockSystem& system,
                                           const Teuchos::ParameterList& list);

}  // namespace lockstep
