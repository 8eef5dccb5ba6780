#pragma once
#include <functional>
#include <vector>

#include "interfaces/gas.hpp"
#include "interfaces/strategy.hpp"

namespace lockstep {

/// What a solve has to know of the pockets of gas.
struct GasProblem {
  std::vector<GasPocket> pockets;
  std::vector<double> conductance;  ///< GasFluid::gas_conductance
  /// GasCoupling::gas_push_size, where a pocket without conductance pushes on solids.
  std::vector<double> push_size;
  double dt = 0;       ///< of p̂ [s]
  double step_dt = 0;  ///< over which the solution moves the pockets' sides [s]
  /// False: only pockets that keep their volume have a pressure (F2).
  bool with_springs = true;
  /// rhs += what these p̂ of the pockets push. Collective.
  std::function<void(const std::vector<double>& scaled_pressure, BlockVector& rhs)> push;
  /// The rate at which a solution opens each pocket, but for the conductance times its own p̂; of a
  /// change of the solution only what that changes. Collective.
  std::function<std::vector<double>(const BlockVector& unknowns, bool is_change)> rates;
};

/// Solves with the pressures of the pockets, which it returns as p̂, and adds what they push to
/// `rhs`. A gas that a step can follow pushes with the pressure of its volume; one that is too
/// stiff, or keeps its volume, answers to the motion within the step: one more solve each, and a
/// small dense system. `report`: of all of them. Collective.
std::vector<double> solve_with_gas(const GasProblem& gas, SolverStrategy& strategy,
                                   const BlockSystem& blocks, const SolveRequest& request,
                                   BlockVector& rhs, BlockVector& unknowns, SolveReport& report);

}  // namespace lockstep
