#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// The preconditioner that a Stratimikos package ("Ifpack2", "MueLu") builds for one assembled
/// block from its own list, handed on unchanged. Throws SolveError, with Trilinos' reason, if the
/// set-up fails. `name` is for messages. Collective.
RCP<const LinearOperator> stratimikos_preconditioner(const RCP<const LinearOperator>& op,
                                                     const std::string& type,
                                                     const Teuchos::ParameterList& list,
                                                     const std::string& name);

}  // namespace lockstep
