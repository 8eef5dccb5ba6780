#pragma once
#include <functional>
#include <vector>

#include "interfaces/gas.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

/// The gas bubbles, as a solve sees them.
struct GasProblem {
  std::vector<GasBubble> bubbles;
  std::vector<double> conductance;  ///< GasFluid::gas_conductance
  /// GasCoupling::gas_push_size, where a bubble without conductance pushes on solids.
  std::vector<double> push_size;
  double dt = 0;       ///< step of p̂ [s]
  double step_dt = 0;  ///< over which the solution moves the bubbles' sides [s]
  /// False: only bubbles that keep their volume have a pressure (F2).
  bool with_springs = true;
  /// rhs += push of these p̂ of the bubbles. Collective.
  std::function<void(const std::vector<double>& scaled_pressure, BlockVector& rhs)> push;
  /// Returns the rate at which a solution opens each bubble, but for the conductance times its own
  /// p̂ [m^dim/s]; for a change of the solution the change of the rate. Collective.
  std::function<std::vector<double>(const BlockVector& unknowns, bool is_change)> rates;
};

/// A strategy that is prepared for the blocks, and what is asked of its solutions.
struct BlockSolver {
  SolverStrategy& strategy;
  const BlockSystem& blocks;
  SolveRequest request;
};

/// Solves with the pressures of the bubbles, which it returns as p̂, and adds their push to `rhs`.
/// A bubble whose oscillation the step resolves is explicit: it pushes with the pressure of its
/// volume. One that is too stiff, or keeps its volume, is implicit: one more solve each, and a
/// small dense system. `report` sums up all solves. Collective.
std::vector<double> solve_with_gas(const GasProblem& gas, const BlockSolver& solver,
                                   BlockVector& rhs, BlockVector& unknowns, SolveReport& report);

}  // namespace lockstep
