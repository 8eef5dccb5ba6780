#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/types.hpp"

namespace Belos {
template <typename Scalar, typename Vectors, typename Operator>
class SolverManager;
}
namespace Thyra {
template <typename Scalar>
class MultiVectorBase;
}

namespace lockstep {

using BelosSolver = Belos::SolverManager<double, Thyra::MultiVectorBase<double>, LinearOperator>;

/// A Belos solver manager for Thyra operators, by name: those of Belos' own factory ("MINRES",
/// "Flexible GMRES", ...) and "Lockstep MINRES", which is solve/minres.hpp. (Stratimikos keeps a
/// closed list of Belos' solvers, so ours cannot be named there.)
///
/// "Lockstep MINRES" takes one right-hand side whose blocks are Tpetra vectors, a left
/// preconditioner that is symmetric positive definite, and the parameters "Convergence Tolerance"
/// (double, 1e-8: each block's true residual over the 2-norm of the initial residual), "Maximum
/// Iterations" (int, 1000) and "Transition Condition" (double, 1e7; see MinresRequest). Throws
/// InputError for other parameters.
RCP<BelosSolver> belos_solver(const std::string& name,
                              const Teuchos::RCP<Teuchos::ParameterList>& list);

}  // namespace lockstep
