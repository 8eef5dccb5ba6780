#include "observers/energy.hpp"

#include "base/errors.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

/// A number of the book, and its column.
struct BudgetColumn {
  ObservedColumn column;
  double EnergyBudget::*value;
};

/// Columns in the order of the table and of checkpoints.
std::vector<BudgetColumn> book_columns() {
  return {
      {{"joints", "J", "work of what controls joints, as joints.csv has it"},
       &EnergyBudget::joints},
      {{"loads", "J", "work of gravity, loads, contact and drops, on fluid and solids"},
       &EnergyBudget::loads},
      {{"kinetic_change", "J", "of the energy of motion of fluid and solids"},
       &EnergyBudget::kinetic_change},
      {{"elastic_change", "J", "of the elastic energy"}, &EnergyBudget::elastic_change},
      {{"fluid_friction", "J", "what viscosity took from fluid and solids"},
       &EnergyBudget::fluid_friction},
      {{"solid_friction", "J", "what the damping of soft solids took"},
       &EnergyBudget::solid_friction},
      {{"transport", "J", "what advection, and the change of the fluid's place, took"},
       &EnergyBudget::transport},
      {{"pressure", "J", "what pressure took; less what moving sides and prescribed solids gave"},
       &EnergyBudget::pressure},
      {{"lumping", "J", "what was lost where fluid is lumped on solids"}, &EnergyBudget::lumping},
      {{"elasticity", "J", "what elastic forces took beside the change of elastic energy"},
       &EnergyBudget::elasticity},
      {{"ties", "J", "what joints and attachments took from velocities they do not let"},
       &EnergyBudget::ties}};
}

std::vector<double> values_of(const EnergyBudget& book) {
  std::vector<double> values;
  for (const BudgetColumn& entry : book_columns())
    values.push_back(book.*entry.value);
  return values;
}

constexpr const char* stored = "energy";

}  // namespace

template <int dim>
ParameterList energy_parameters() {
  return {};
}

template <int dim>
std::vector<ObservedColumn> Energy<dim>::columns() const {
  std::vector<ObservedColumn> columns;
  for (const BudgetColumn& entry : book_columns())
    columns.push_back(entry.column);
  columns.push_back({"left", "J", "of joints and loads, what is in none of these"});
  return columns;
}

template <int dim>
void Energy<dim>::follow(const RunView<dim>& run) {
  if (run.energy)
    total_ += *run.energy;
}

template <int dim>
std::vector<std::vector<double>> Energy<dim>::observe(const RunView<dim>& run) {
  check_input(run.fluid.energy() != nullptr,
              "The fluid \"{}\" cannot tell what is done to its energy, which the observer "
              "\"energy\" wants; leave that observer out.",
              run.fluid.name());
  std::vector<double> row = values_of(total_);
  row.push_back(total_.left());
  return {row};
}

template <int dim>
void Energy<dim>::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().write_replicated(stored, values_of(total_));
}

template <int dim>
void Energy<dim>::load(const CheckpointReader& checkpoint) {
  const std::vector<double> values = checkpoint.file().read_all<double>(stored);
  check_input(values.size() == book_columns().size(),
              "{}: the checkpoint's \"{}\" is incomplete; restart from another one.",
              checkpoint.file().path(), stored);
  auto value = values.begin();
  for (const BudgetColumn& entry : book_columns())
    total_.*entry.value = *value++;
}

template ParameterList energy_parameters<2>();
template ParameterList energy_parameters<3>();
template class Energy<2>;
template class Energy<3>;

}  // namespace lockstep
