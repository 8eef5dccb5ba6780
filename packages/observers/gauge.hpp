#pragma once
#include "interfaces/observer.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "gauge".
template <int dim>
ParameterList gauge_parameters();

/// Wet length of a straight line, as a wire gauge measures it: samples half of the fluid's h apart,
/// linear between them.
template <int dim>
class Gauge : public Observer<dim> {
 public:
  explicit Gauge(const ParameterList& list);
  std::string name() const override { return "gauge"; }
  std::vector<ObservedColumn> columns() const override;
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;

 private:
  Point<dim> foot_, head_;  ///< [m]
};

}  // namespace lockstep
