#pragma once
#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <string>

#include "interfaces/strategy.hpp"
#include "strategies/common/flat_system.hpp"

namespace lockstep {

/// One correction by a Krylov method on Eq. 16: right-hand side (rhs, 0), zero guess.
struct BlockKrylovRequest {
  std::string name;         ///< for messages
  double target = 0;        ///< target of |r_1|
  double solid_target = 0;  ///< target of |r_2|, so small that B C^-1 r_2, which back-substitution
                            ///< of V_S adds to r_1, is no larger than `target`
  int maximum_iterations = 0;
};

/// A solver of Belos, applied to Eq. 16. Both rows are scaled so that their residuals mean the same
/// beside their targets, and a symmetric preconditioner so that Belos' two residual norms do.
class BelosMethod {
 public:
  /// `list` is Stratimikos' "Linear Solver Types" / "Belos": "Solver Type" and, in "Solver Types",
  /// its settings; of these "Convergence Tolerance" is what one solve aims at, at most, and
  /// "Maximum Iterations" ends one. Throws InputError for a list without "Solver Type".
  explicit BelosMethod(const Teuchos::ParameterList& list);
  ~BelosMethod();

  /// True for MINRES and conjugate gradients, which take symmetric positive definite
  /// preconditioners alone and go by a recurrence that presumes them exact.
  bool is_symmetric() const;
  /// Writes p̂ of an approximate solution; returns the number of iterations. An iteration that ends
  /// early is no failure: the caller looks at what is left. `preconditioner` acts on blocked
  /// vectors; null: none. Throws SolveError on a breakdown. Collective.
  int correct(const BlockSystem& system, const FlatSystem& flat,
              const RCP<const LinearOperator>& preconditioner, const Vector& rhs,
              const BlockKrylovRequest& request, Vector& pressure) const;

 private:
  /// Stratimikos' builder and what it made, out of sight of other files.
  struct Trilinos;

  std::string solver_;
  double tolerance_ = 0;        ///< tolerance of the list; 0: none
  int maximum_iterations_ = 0;  ///< likewise
  std::unique_ptr<Trilinos> trilinos_;
};

/// The list of Belos' MINRES.
Teuchos::ParameterList minres_list();

}  // namespace lockstep
