#include "observers/energy.hpp"

#include "base/errors.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

/// Its numbers, in the order of the columns.
std::vector<double EnergyBook::*> numbers() {
  return {&EnergyBook::joints,
          &EnergyBook::loads,
          &EnergyBook::kinetic_change,
          &EnergyBook::elastic_change,
          &EnergyBook::fluid_friction,
          &EnergyBook::solid_friction,
          &EnergyBook::transport,
          &EnergyBook::pressure,
          &EnergyBook::lumping,
          &EnergyBook::elasticity,
          &EnergyBook::ties};
}

constexpr const char* stored = "energy";

}  // namespace

template <int dim>
ParameterList energy_parameters() {
  return {};
}

template <int dim>
std::vector<ObservedColumn> Energy<dim>::columns() const {
  return {
      {"joints", "J", "work of what controls joints, as joints.csv has it"},
      {"loads", "J", "work of gravity, loads, contact and drops, on fluid and solids"},
      {"kinetic_change", "J", "of the energy of motion of fluid and solids"},
      {"elastic_change", "J", "of the elastic energy"},
      {"fluid_friction", "J", "what viscosity took from fluid and solids"},
      {"solid_friction", "J", "what the damping of soft solids took"},
      {"transport", "J", "what advection, and the change of the fluid's place, took"},
      {"pressure", "J", "what pressure took; less what moving sides and prescribed solids gave"},
      {"lumping", "J", "what was lost where fluid is lumped on solids"},
      {"elasticity", "J", "what elastic forces took beside the change of elastic energy"},
      {"ties", "J", "what joints and attachments took from velocities they do not let"},
      {"left", "J", "of joints and loads, what is in none of these"}};
}

template <int dim>
void Energy<dim>::follow(const RunView<dim>& run) {
  if (run.energy)
    total_ += *run.energy;
}

template <int dim>
std::vector<std::vector<double>> Energy<dim>::observe(const RunView<dim>& run) {
  check_input(side_of<EnergyFluid<dim>>(run.fluid) != nullptr,
              "The fluid \"{}\" cannot tell what is done to its energy, which the observer "
              "\"energy\" wants; leave that observer out.",
              run.fluid.name());
  std::vector<double> row;
  for (const auto number : numbers())
    row.push_back(total_.*number);
  row.push_back(total_.left());
  return {row};
}

template <int dim>
void Energy<dim>::save(CheckpointWriter& checkpoint) const {
  std::vector<double> values;
  for (const auto number : numbers())
    values.push_back(total_.*number);
  checkpoint.file().write_replicated(stored, values);
}

template <int dim>
void Energy<dim>::load(const CheckpointReader& checkpoint) {
  const std::vector<double> values = checkpoint.file().read_all<double>(stored);
  check_input(values.size() == numbers().size(),
              "{}: the checkpoint's \"{}\" is incomplete; restart from another one.",
              checkpoint.file().path(), stored);
  auto value = values.begin();
  for (const auto number : numbers())
    total_.*number = *value++;
}

template ParameterList energy_parameters<2>();
template ParameterList energy_parameters<3>();
template class Energy<2>;
template class Energy<3>;

}  // namespace lockstep
