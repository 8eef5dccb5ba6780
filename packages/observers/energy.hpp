#pragma once
#include "interfaces/observer.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "energy".
template <int dim>
ParameterList energy_parameters();

/// Where the energy of a run comes from and where it goes, from its start on.
template <int dim>
class Energy : public Observer<dim> {
 public:
  std::string name() const override { return "energy"; }
  std::vector<ObservedColumn> columns() const override;
  void follow(const RunView<dim>& run) override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;
  bool wants_energy() const override { return true; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;

 private:
  EnergyBudget total_;  ///< since the start of the run
};

}  // namespace lockstep
