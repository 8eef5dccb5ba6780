#include "coupling/gas_solve.hpp"

#include <Eigen/Core>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "linear/least_squares.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/null_space.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/block_residual.hpp"

namespace lockstep {

namespace {
/// A bubble that opens at less than this part of its rate without an answering pressure cannot
/// open: it is closed in [1].
constexpr double closed_in = 1e-12;

/// Solution for p̂ = 1 in one bubble.
struct Answer {
  int bubble = 0;
  BlockVector unknowns;
  std::vector<double> rates;  ///< opening rates of all bubbles [m^dim/s]
};

/// Returns the rate at which the bubble's push opens it if solids move by the diagonal of their
/// mass alone [m^dim/s].
double opened_by_solids(int bubble, const GasProblem& gas, const BlockSystem& blocks,
                        const BlockVector& rhs) {
  const auto mass = blocks.has_solid() ? assembled(blocks.solid_block()) : RCP<const CrsMatrix>();
  if (mass.is_null())
    return 0;
  BlockVector moved{make_vector(rhs.pressure->getMap()), make_vector(rhs.solid->getMap())};
  Vector inverse(rhs.solid->getMap());
  inverse.reciprocal(*diagonal_of(*mass));
  moved.solid->elementWiseMultiply(1, inverse, *rhs.solid, 0);
  return std::abs(gas.rates(moved, true)[bubble]);
}

/// Round-off of the pressure rows where p̂ is about 1 everywhere.
double round_off_of_rows(const BlockSystem& blocks, const RCP<const Map>& map) {
  constexpr double round_off = 1e-14;
  Vector unit(map), product(map);
  pseudo_random(unit, 1);
  unit.scale(1 / std::max(unit.normInf(), 1e-300));
  apply(*blocks.pressure_block(), unit, product);
  return round_off * product.norm2();
}

/// True if only solids are beside the bubble and its pushes on them cancel to round-off, as within
/// one shell.
bool pushes_cancel(int bubble, const GasProblem& gas, const BlockVector& rhs) {
  constexpr double round_off = 1e-14;
  return gas.conductance[bubble] == 0 &&
         (rhs.solid.is_null() || rhs.solid->normInf() <= round_off * gas.push_size[bubble]);
}

/// Solves for p̂ = 1 in one bubble; empty if nothing that it pushes on can open it.
std::optional<Answer> answer_to(int bubble, const GasProblem& gas, const BlockSolver& solver,
                                const BlockVector& like, SolveReport& report) {
  const auto& [strategy, blocks, request] = solver;
  const auto zero = [](const RCP<Vector>& v) {
    return v.is_null() ? RCP<Vector>() : make_vector(v->getMap());
  };
  BlockVector rhs{zero(like.pressure), zero(like.solid)};
  Answer answer{bubble, {zero(like.pressure), zero(like.solid)}, {}};
  std::vector<double> unit(gas.bubbles.size(), 0);
  unit[bubble] = 1;
  gas.push(unit, rhs);
  if (pushes_cancel(bubble, gas, rhs))
    return {};
  relative_part_removed(blocks.null_space, *rhs.pressure);
  // The rate at which the bubble opens is a small difference of the flows through its faces. If
  // only solids are beside it and all is closed in, pressures hold them still, and the right-hand
  // side of the pressure rows, to which the tolerance is relative, vanishes.
  SolveRequest exact{request.name + ", gas", std::min(request.tolerance, 1e-10), 0, request.step};
  if (gas.conductance[bubble] == 0)
    exact.negligible_pressure_residual = round_off_of_rows(blocks, like.pressure->getMap());
  report.add_work(strategy.solve(blocks, rhs, answer.unknowns, exact));
  answer.rates = gas.rates(answer.unknowns, true);
  answer.rates[bubble] += gas.conductance[bubble];
  // All volume that flows through the bubble's faces flows out elsewhere, but for the residual of
  // the solve. Without that residual the rate of a bubble that is closed in is zero.
  const BlockResidual left = block_residual(blocks, rhs, answer.unknowns);
  answer.rates[bubble] -=
      left.vector.pressure->meanValue() * left.vector.pressure->getGlobalLength();
  const double unanswered = gas.conductance[bubble] + opened_by_solids(bubble, gas, blocks, rhs);
  if (answer.rates[bubble] <= closed_in * unanswered)
    return {};
  return answer;
}

/// The part of a gas spring's answer that is taken at the end of the step: none up to omega dt = 1,
/// so that the spring conserves energy, then as much as keeps it stable.
double implicit_part(double stiffness_times_answer) {
  return stiffness_times_answer > 1 ? 1 - 1 / stiffness_times_answer : 0;
}
}  // namespace

std::vector<double> solve_with_gas(const GasProblem& gas, const BlockSolver& solver,
                                   BlockVector& rhs, BlockVector& unknowns, SolveReport& report) {
  const int n = static_cast<int>(gas.bubbles.size());
  std::vector<double> pressure(n, 0);
  for (int k = 0; k < n; ++k)
    if (gas.with_springs || gas.bubbles[k].keeps_volume)
      pressure[k] = gas.dt * gas.bubbles[k].pressure;
  gas.push(pressure, rhs);
  report = solver.strategy.solve(solver.blocks, rhs, unknowns, solver.request);

  const double dt = gas.dt;
  std::vector<Answer> answers;
  std::vector<double> compliance;
  for (int k = 0; k < n; ++k) {
    const GasBubble& bubble = gas.bubbles[k];
    const double stiff = dt * dt * bubble.stiffness;
    const bool may_be_stiff =
        !unknowns.solid.is_null() || stiff * gas.conductance[k] > 1;  // solids answer, too
    if (!bubble.keeps_volume && !(gas.with_springs && may_be_stiff))
      continue;
    std::optional<Answer> answer = answer_to(k, gas, solver, unknowns, report);
    if (!answer)
      continue;
    const double part = bubble.keeps_volume ? 1 : implicit_part(stiff * answer->rates[k]);
    if (part == 0)
      continue;
    answers.push_back(std::move(*answer));
    compliance.push_back(bubble.keeps_volume ? 0 : 1 / (part * stiff));
  }
  if (answers.empty())
    return pressure;

  const int m = static_cast<int>(answers.size());
  std::vector<double> rates = gas.rates(unknowns, false);
  Eigen::MatrixXd matrix(m, m);
  Eigen::VectorXd wanted(m);
  for (int i = 0; i < m; ++i) {
    const int k = answers[i].bubble;
    const GasBubble& bubble = gas.bubbles[k];
    wanted[i] = (bubble.keeps_volume ? bubble.missing / gas.step_dt : 0) - rates[k] -
                gas.conductance[k] * pressure[k];
    for (int j = 0; j < m; ++j)
      matrix(i, j) = answers[j].rates[k] + (i == j ? compliance[i] : 0);
  }
  // The shortest solution prefers none of several bubbles that can only change together.
  const Eigen::VectorXd change = least_squares(matrix, wanted, 1e-7);
  std::vector<double> changes(n, 0);
  for (int i = 0; i < m; ++i) {
    changes[answers[i].bubble] = change[i];
    pressure[answers[i].bubble] += change[i];
    unknowns.pressure->update(change[i], *answers[i].unknowns.pressure, 1);
    if (!unknowns.solid.is_null())
      unknowns.solid->update(change[i], *answers[i].unknowns.solid, 1);
  }
  gas.push(changes, rhs);
  return pressure;
}

}  // namespace lockstep
