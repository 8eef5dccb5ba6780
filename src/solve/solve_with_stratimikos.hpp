#pragma once
#include <Teuchos_ParameterList.hpp>

#include "interfaces/strategy.hpp"

namespace lockstep {

struct StratimikosReport {
  int iterations = 0;
  double pressure_residual = 0;  ///< ||r_1|| / max(||rhs_1||, ||A p̂||, ||B V_S||)
  double solid_residual = 0;     ///< ||r_2|| / max(||rhs_2||, ||B^T p̂||, ||C V_S||)
};

/// Solves Eq. 16 with stock Stratimikos, Belos and Teko as `list` says; `solution` holds the
/// initial guess. The tolerance is Belos' own, relative to the initial residual. The list is
/// validated, keys inside Teko's factories included. The Teko factory "SPD Block Diagonal" is
/// available: diag(A^-1, C^-1) with the library entries "Fluid Inverse Type" and "Solid Inverse
/// Type". Throws InputError for a bad list, SolveError if Belos does not converge. Collective.
StratimikosReport solve_with_stratimikos(const BlockSystem& system, const BlockVector& rhs,
                                         BlockVector& solution, const Teuchos::ParameterList& list);

}  // namespace lockstep
