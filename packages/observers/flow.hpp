#pragma once
#include "interfaces/observer.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "flow".
template <int dim>
ParameterList flow_parameters();

/// Volume that flows through a window at right angles to an axis, by the midpoint rule over squares
/// of at most the fluid's h; what solids cover lets nothing through, and a face that they cover in
/// part the open part.
template <int dim>
class Flow : public Observer<dim> {
 public:
  explicit Flow(const ParameterList& list);
  std::string name() const override { return "flow"; }
  std::vector<ObservedColumn> columns() const override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;

 private:
  /// Throws InputError if there is none.
  Box<dim> part_in(const FluidDiscretization<dim>& fluid) const;

  int axis_ = 0;
  Box<dim> window_;  ///< without extent along the axis [m]
};

}  // namespace lockstep
