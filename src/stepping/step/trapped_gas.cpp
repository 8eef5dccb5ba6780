#include "stepping/step/trapped_gas.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/shortened.hpp"

namespace lockstep {

namespace {

/// Names of the solids that a script moves, for messages: ' ("Piston")', or nothing.
template <int dim>
std::string prescribed_names(const SolidSystem<dim>& solids) {
  std::vector<std::string> names;
  const std::vector<SolidState<dim>> states = solids.states();
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (solids.solids()[i].prescribed && !states[i].velocity.isZero())
      names.push_back('"' + solids.solids()[i].name + '"');
  }
  return names.empty()
             ? ""
             : fmt::format(" ({})", shortened(fmt::format("{}", fmt::join(names, ", ")), 200));
}

}  // namespace

template <int dim>
TrappedGas<dim>::TrappedGas(const Components<dim>& components)
    : components_(components),
      fluid_(components.fluid->gas()),
      coupling_(components.coupling->gas()) {
  check_input(!fluid_ || coupling_,
              "The coupling \"{}\" knows no gas that pushes on solids; take another one, or leave "
              "\"Trapped Air\" at \"massless\".",
              components.coupling->name());
}

template <int dim>
bool TrappedGas<dim>::is_there() const {
  return fluid_ && !fluid_->gas_bubbles().empty();
}

template <int dim>
std::vector<double> TrappedGas<dim>::expected_pressure(double dt) const {
  std::vector<double> result;
  if (!is_there())
    return result;
  for (const GasBubble& bubble : fluid_->gas_bubbles())
    result.push_back(dt * bubble.pressure);
  return result;
}

template <int dim>
void TrappedGas<dim>::project(const Vector& scaled_pressure,
                              const std::vector<double>& gas_pressure) const {
  if (gas_pressure.empty())
    components_.fluid->project(scaled_pressure);
  else
    fluid_->project(scaled_pressure, gas_pressure);
}

template <int dim>
GasProblem TrappedGas<dim>::problem(double dt, double step_dt) const {
  GasProblem gas;
  gas.bubbles = fluid_->gas_bubbles();
  gas.conductance = fluid_->gas_conductance();
  gas.dt = dt;
  gas.step_dt = step_dt;
  return gas;
}

template <int dim>
void TrappedGas<dim>::solve(const StepContext<dim>& context, const BlockSystem& blocks,
                            const SolveRequest& request, CoupledSolution& solution) const {
  if (!is_there()) {
    solution.report = components_.strategy->solve(blocks, solution.rhs, solution.unknowns, request);
    return;
  }
  const Reduction& constraints = context.constraints;
  const auto& solids = *components_.solids;
  GasProblem gas = problem(context.dt, context.step.dt);
  const int n = static_cast<int>(gas.bubbles.size());
  const auto& conductance = gas.conductance;
  if (std::find(conductance.begin(), conductance.end(), 0.) != conductance.end())
    gas.push_size = coupling_->gas_push_size(n);
  gas.push = [&](const std::vector<double>& pressure, BlockVector& rhs) {
    fluid_->add_gas_push(pressure, *rhs.pressure);
    if (rhs.solid.is_null())
      return;
    const RCP<Vector> given = make_vector(solids.map());
    coupling_->add_gas_push(pressure, *given);
    constraints.restrict(*given);
    rhs.solid->update(1, *given, 1);
  };
  gas.rates = [&](const BlockVector& unknowns, bool is_change) {
    Vector velocity(solids.map());
    if (!unknowns.solid.is_null()) {
      velocity.update(1, *unknowns.solid, 0);
      if (!constraints.is_identity())
        is_change ? constraints.expand_change(velocity) : constraints.expand(velocity);
    }
    std::vector<double> rates = coupling_->gas_rates(velocity, !is_change, n);
    const std::vector<double> answer = fluid_->gas_answer(*unknowns.pressure);
    const std::vector<double> before = is_change ? std::vector<double>(n, 0) : fluid_->gas_rates();
    for (int k = 0; k < n; ++k)
      rates[k] += before[k] - answer[k];
    return rates;
  };
  solution.gas_pressure = solve_with_gas(gas, {*components_.strategy, blocks, request},
                                         solution.rhs, solution.unknowns, solution.report);
  if (!context.moves_positions)
    check_volumes(context, gas, solution);
  solution.gas_momentum = make_vector(solids.map());
  coupling_->add_gas_push(solution.gas_pressure, *solution.gas_momentum);
}

/// Pressures of bubbles that something gives way to leave them the rate that is wanted. The grid
/// sees solids that cross each other as a little more or less than they are: that may change a
/// bubble, too, but not by much, and it comes back.
template <int dim>
void TrappedGas<dim>::check_volumes(const StepContext<dim>& context, const GasProblem& gas,
                                    const CoupledSolution& solution) const {
  constexpr double most = 1e-3, round_off = 1e-6;  // parts of the volume
  const auto keeps_volume = [](const GasBubble& bubble) { return bubble.keeps_volume; };
  if (std::none_of(gas.bubbles.begin(), gas.bubbles.end(), keeps_volume))
    return;
  const double smallest = std::pow(3 * components_.fluid->smallest_length(), dim);
  const std::vector<double> rates = gas.rates(solution.unknowns, false);
  for (std::size_t k = 0; k < rates.size(); ++k) {
    const GasBubble& bubble = gas.bubbles[k];
    const double rate = rates[k] + gas.conductance[k] * solution.gas_pressure[k];
    const double wanted = bubble.missing / gas.step_dt;
    const double grown = gas.step_dt * std::abs(rate) / bubble.volume;
    const bool gets_worse = rate * wanted <= 0 && grown > round_off;
    const bool is_impossible =
        gets_worse && std::max(grown, std::abs(bubble.missing) / bubble.volume) > most;
    if (!bubble.keeps_volume || bubble.volume <= smallest || !is_impossible)
      continue;
    const bool at_start = context.step.number == 1;
    const std::string message = fmt::format(
        "{}: {:.3g} {unit} of gas that keeps its volume are closed in, but what is prescribed{} "
        "changes them by {:.3g} {unit}/s and nothing around them gives way. Let the gas out, move "
        "so that its volume stays, or set \"Trapped Air\" to \"ideal gas\".",
        at_start ? "At the start" : fmt::format("At {:.6g} s", context.step.end()), bubble.volume,
        prescribed_names(*components_.solids), rate, fmt::arg("unit", dim == 2 ? "m^2" : "m^3"));
    check_input(!at_start, "{}", message);
    check_solve(false, "{}", message);
  }
}

template <int dim>
void TrappedGas<dim>::solve_advection(double dt, const BlockSystem& blocks,
                                      const SolveRequest& request,
                                      CoupledSolution& solution) const {
  if (!is_there()) {
    solution.report = components_.strategy->solve(blocks, solution.rhs, solution.unknowns, request);
    return;
  }
  GasProblem gas = problem(dt, dt);
  const int n = static_cast<int>(gas.bubbles.size());
  gas.with_springs = false;
  for (GasBubble& bubble : gas.bubbles)
    bubble.pressure = 0;  // u^n has felt it
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    fluid_->add_gas_push(pressure, *to.pressure);
  };
  gas.rates = [&](const BlockVector& unknowns, bool is_change) {
    std::vector<double> rates = fluid_->gas_answer(*unknowns.pressure);
    const std::vector<double> none(n, 0);
    const std::vector<double> before = is_change ? none : fluid_->gas_rates();
    const std::vector<double> solids =
        is_change ? none : coupling_->effective_gas_rates(*components_.solids, n);
    for (int k = 0; k < n; ++k)
      rates[k] = before[k] + solids[k] - rates[k];
    return rates;
  };
  solution.gas_pressure = solve_with_gas(gas, {*components_.strategy, blocks, request},
                                         solution.rhs, solution.unknowns, solution.report);
}

template class TrappedGas<2>;
template class TrappedGas<3>;

}  // namespace lockstep
