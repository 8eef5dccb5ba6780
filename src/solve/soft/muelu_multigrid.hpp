#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// MueLu's preconditioner for a matrix with `n_equations` consecutive rows a node and the given
/// near null space; `list` goes to MueLu unchanged. Throws SolveError if MueLu fails. Collective.
RCP<const LinearOperator> muelu_multigrid(const RCP<CrsMatrix>& matrix, int n_equations,
                                          const RCP<MultiVector>& near_null_space,
                                          const Teuchos::ParameterList& list,
                                          const std::string& name);

}  // namespace lockstep
