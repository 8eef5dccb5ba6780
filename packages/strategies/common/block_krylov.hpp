#pragma once
#include <string>

#include "interfaces/strategy.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

/// One correction by a Krylov method on Eq. 16 as a block operator: right-hand side (rhs, 0), zero
/// guess.
struct BlockKrylovRequest {
  std::string name;         ///< for messages
  double target = 0;        ///< of |r_1|
  double solid_target = 0;  ///< of |r_2|, so small that B C^-1 r_2, which back-substitution of V_S
                            ///< adds to r_1, is no larger than `target`
  int maximum_iterations = 0;
};

/// Declares "Krylov Method" for strategies that use MINRES: "Lockstep MINRES" (MINRES-QLP of
/// solve/minres.hpp: right on singular systems and on ranks that own no row, stops block by block)
/// or "Belos MINRES" (every rank must own rows of both blocks; reduces a residual by 1e9 at most).
void declare_minres(ParameterList& list, const std::string& standard);
/// Which one the list names. Throws InputError if neither.
enum class MinresKind { lockstep, belos };
MinresKind minres_kind(const ParameterList& list);

/// MINRES preconditioned by diag(pressure_inverse, solid_inverse); writes p̂. Returns the number of
/// iterations; the caller refines. Throws SolveError on a breakdown. Collective.
int solve_by_minres(MinresKind kind, const BlockSystem& system, const Vector& rhs,
                    const BlockKrylovRequest& request,
                    const RCP<const LinearOperator>& pressure_inverse,
                    const RCP<const LinearOperator>& solid_inverse, Vector& pressure);

/// Eq. 16 scaled symmetrically by the largest diagonal entries of its blocks, with a right
/// preconditioner, for flexible GMRES. Teko keeps vectors of its first application, whose space
/// must live as long as the preconditioner: hence both together.
struct ScaledSystem {
  double s = 1, t = 1;
  RCP<const LinearOperator> op;  ///< [s^2 A, -s t B; -s t B^T, -t^2 C]
  RCP<const LinearOperator> preconditioner;
};
/// Without the preconditioner. Throws SolveError if some rank owns no row of a block. Collective.
ScaledSystem scaled_system(const BlockSystem& system, const std::string& who);

/// Belos' flexible GMRES, restarted after `restart` iterations. The rest as above.
int solve_by_flexible_gmres(const ScaledSystem& system, const Vector& rhs,
                            const BlockKrylovRequest& request, int restart, Vector& pressure);

}  // namespace lockstep
