#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace Thyra {
template <typename Scalar>
class LinearOpWithSolveBase;
}

namespace lockstep {

/// The preconditioner that a Stratimikos package ("Ifpack2", "MueLu") builds for one assembled
/// block from its own list, handed on unchanged. Throws SolveError, with Trilinos' reason, if the
/// set-up fails. `name` is for messages. Collective.
RCP<const LinearOperator> stratimikos_preconditioner(const RCP<const LinearOperator>& op,
                                                     const std::string& type,
                                                     const Teuchos::ParameterList& list,
                                                     const std::string& name);

/// The solver that a Stratimikos list describes for `op`; the list is validated with
/// check_solver_list first. Throws InputError or SolveError. Collective.
RCP<Thyra::LinearOpWithSolveBase<double>> linear_op_with_solve(const RCP<const LinearOperator>& op,
                                                               const Teuchos::ParameterList& list);

}  // namespace lockstep
