#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// Holds a Stratimikos list against the names its packages know, including those inside Teko's
/// "Inverse Factory Library", which Trilinos leaves unchecked. Throws InputError naming the place,
/// with a suggestion. Also refuses direct solvers that are wrong on several ranks.
void check_solver_list(const Teuchos::ParameterList& list);

/// Holds the list of one package, "Ifpack2" or "MueLu", against the names that it knows; `where` is
/// for messages.
void check_package_list(const std::string& package, const Teuchos::ParameterList& list,
                        const std::string& where);

}  // namespace lockstep
