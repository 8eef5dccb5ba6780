// What pockets of gas beside a liquid add to the step.
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "coupling/gas_solve.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

template <int dim>
bool Stepper<dim>::has_gas() const {
  return sides_.gas_fluid && sides_.gas_fluid->holds_gas() &&
         !sides_.gas_fluid->gas_pockets().empty();
}

/// p̂ of the pockets at the start of a solve.
template <int dim>
std::vector<double> Stepper<dim>::expected_gas_pressure(double dt) const {
  std::vector<double> result;
  for (const GasPocket& pocket : sides_.gas_fluid->gas_pockets())
    result.push_back(dt * pocket.pressure);
  return result;
}

/// Of the fluid, and of the pockets; empty: there are none.
template <int dim>
void Stepper<dim>::project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) {
  if (gas_pressure.empty())
    components_.fluid->project(scaled_pressure);
  else
    sides_.gas_fluid->project(scaled_pressure, gas_pressure);
}

/// Solves S1 or S2 with the pockets' pressures.
template <int dim>
void Stepper<dim>::solve_coupled(const StepContext<dim>& context, const BlockSystem& blocks,
                                 const SolveRequest& request, CoupledSolution& solution,
                                 SolveReport& report) {
  if (!has_gas()) {
    report = components_.strategy->solve(blocks, solution.rhs, solution.unknowns, request);
    return;
  }
  GasFluid<dim>& fluid = *sides_.gas_fluid;
  GasCoupling<dim>& coupling = *sides_.gas_coupling;
  const Reduction& constraints = context.constraints;
  const auto& solids = *components_.solids;
  const int n = static_cast<int>(fluid.gas_pockets().size());
  GasProblem gas;
  gas.pockets = fluid.gas_pockets();
  gas.conductance = fluid.gas_conductance();
  const auto& conductance = gas.conductance;
  if (std::find(conductance.begin(), conductance.end(), 0.) != conductance.end())
    gas.push_size = coupling.gas_push_size(n);
  gas.dt = context.dt;
  gas.step_dt = context.step_dt;
  gas.push = [&](const std::vector<double>& pressure, BlockVector& rhs) {
    fluid.add_gas_push(pressure, *rhs.pressure);
    if (rhs.solid.is_null())
      return;
    const RCP<Vector> given = make_vector(solids.map());
    coupling.add_gas_push(pressure, *given);
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
    std::vector<double> rates =
        coupling.gas_rates(coupling.closed_velocity(velocity, !is_change), n);
    const std::vector<double> answer = fluid.gas_answer(*unknowns.pressure);
    const std::vector<double> before = is_change ? std::vector<double>(n, 0) : fluid.gas_rates();
    for (int k = 0; k < n; ++k)
      rates[k] += before[k] - answer[k];
    return rates;
  };
  const std::vector<double> pressure = solve_with_gas(gas, *components_.strategy, blocks, request,
                                                      solution.rhs, solution.unknowns, report);
  solution.gas_momentum = make_vector(solids.map());
  coupling.add_gas_push(pressure, *solution.gas_momentum);
  solution.gas_pressure = pressure;
}

/// F2: pockets that keep their volume do so in u_ADV, too; others have the solids' effective
/// velocities change it by no more than the next solve answers. Returns their p̂.
template <int dim>
std::vector<double> Stepper<dim>::solve_advection(double dt, const std::vector<double>& effective,
                                                  const BlockSystem& blocks, BlockVector& rhs,
                                                  BlockVector& solution, SolveReport& report) {
  const SolveRequest asked = request(name_of(Stage::F2), dt);
  if (!has_gas()) {
    report = components_.strategy->solve(blocks, rhs, solution, asked);
    return {};
  }
  GasFluid<dim>& fluid = *sides_.gas_fluid;
  GasCoupling<dim>& coupling = *sides_.gas_coupling;
  const int n = static_cast<int>(fluid.gas_pockets().size());
  GasProblem gas;
  gas.pockets = fluid.gas_pockets();
  gas.conductance = fluid.gas_conductance();
  gas.dt = gas.step_dt = dt;
  gas.with_springs = false;
  for (GasPocket& pocket : gas.pockets)
    pocket.pressure = 0;  // u^n has felt it
  gas.push = [&](const std::vector<double>& pressure, BlockVector& to) {
    fluid.add_gas_push(pressure, *to.pressure);
  };
  gas.rates = [&](const BlockVector& unknowns, bool is_change) {
    std::vector<double> rates = fluid.gas_answer(*unknowns.pressure);
    const std::vector<double> before = is_change ? std::vector<double>(n, 0) : fluid.gas_rates();
    const std::vector<double> solids =
        is_change ? std::vector<double>(n, 0) : coupling.gas_rates(effective, n);
    for (int k = 0; k < n; ++k)
      rates[k] = before[k] + solids[k] - rates[k];
    return rates;
  };
  return solve_with_gas(gas, *components_.strategy, blocks, asked, rhs, solution, report);
}

template bool Stepper<2>::has_gas() const;
template bool Stepper<3>::has_gas() const;
template std::vector<double> Stepper<2>::expected_gas_pressure(double) const;
template std::vector<double> Stepper<3>::expected_gas_pressure(double) const;
template void Stepper<2>::project(const Vector&, const std::vector<double>&);
template void Stepper<3>::project(const Vector&, const std::vector<double>&);
template void Stepper<2>::solve_coupled(const StepContext<2>&, const BlockSystem&,
                                        const SolveRequest&, CoupledSolution&, SolveReport&);
template void Stepper<3>::solve_coupled(const StepContext<3>&, const BlockSystem&,
                                        const SolveRequest&, CoupledSolution&, SolveReport&);
template std::vector<double> Stepper<2>::solve_advection(double, const std::vector<double>&,
                                                         const BlockSystem&, BlockVector&,
                                                         BlockVector&, SolveReport&);
template std::vector<double> Stepper<3>::solve_advection(double, const std::vector<double>&,
                                                         const BlockSystem&, BlockVector&,
                                                         BlockVector&, SolveReport&);

}  // namespace lockstep
