#pragma once
#include <functional>
#include <string>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// The parts of a vector of a block system, on maps of their own.
using Blocks = std::vector<RCP<Vector>>;

/// y = (operator) x, all blocks. Collective.
using BlockAction = std::function<void(const Blocks& x, Blocks& y)>;

struct MinresRequest {
  std::string name;             ///< for messages
  std::vector<double> targets;  ///< what the 2-norm of each block's residual is to be at most
  int maximum_iterations = 0;
  /// Above this estimate of the condition number updates go by MINRES-QLP, which keeps the digits
  /// that plain MINRES loses; below, the two agree and MINRES is cheaper by one vector pass.
  double transition_condition = 1e7;
  /// |M (A r)| over its norms: below this r is a least-squares residual, and no iteration will
  /// reduce it. Reported, not an error here.
  double least_squares_tolerance = 1e-10;
};

struct MinresReport {
  int n_iterations = 0;
  int n_qlp_iterations = 0;       ///< of these, by MINRES-QLP
  bool converged = false;         ///< all targets reached, by the true residual
  bool is_least_squares = false;  ///< stopped at a minimum of |r| that is above the targets
  std::vector<double> residuals;  ///< true 2-norms of the blocks of b - A x
  double condition = 1;           ///< estimate, of the preconditioned operator
};

/// MINRES-QLP (Choi, Paige and Saunders 2011; preconditioned form of Choi and Saunders 2014) on a
/// symmetric, maybe indefinite and maybe singular operator, with a symmetric positive definite
/// preconditioner. `x` holds the initial guess; an exact one returns at once. Of a singular
/// compatible system it finds the solution nearest the guess, of an incompatible one a
/// least-squares solution (both in the preconditioner's norm). Stops when each block's residual is
/// below its target: the recurrence says when to look, the true residual decides. Throws SolveError
/// if something is not finite or the preconditioner not positive definite. Right on ranks that own
/// no row of a block. Collective.
MinresReport minres(const BlockAction& op, const BlockAction& preconditioner, const Blocks& rhs,
                    Blocks& x, const MinresRequest& request);

}  // namespace lockstep
