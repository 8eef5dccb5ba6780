#pragma once
#include <vector>

#include "interfaces/gas.hpp"
#include "liquid/gas/gas_faces.hpp"
#include "mac/state/mac_flow.hpp"

namespace lockstep {

/// The gas bubbles beside the liquid of a fluid.
template <int dim>
class MacGas : public GasFluid<dim> {
 public:
  /// `flow` holds gas.
  explicit MacGas(MacFlow<dim>& flow) : flow_(flow), bubbles_(*flow.liquid->gas()) {}

  const std::vector<GasBubble>& gas_bubbles() const override { return bubbles_.all(); }
  void add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const override;
  std::vector<double> gas_conductance() const override;
  std::vector<double> gas_rates() const override;
  std::vector<double> gas_answer(const Vector& scaled_pressure) const override;
  void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) override;
  Momentum<dim> gas_side_impulse(const std::vector<double>& scaled_pressure) const override;

  void settle();                                   ///< for the frozen geometry. Collective.
  void accept(double dt) { bubbles_.accept(dt); }  ///< a step of dt

 private:
  /// Sums value(face) over the faces of each bubble. Collective.
  template <typename Value>
  std::vector<double> sum_of_bubbles(const Value& value) const;

  MacFlow<dim>& flow_;
  GasBubbles<dim>& bubbles_;
  std::vector<GasFace> faces_;
};

}  // namespace lockstep
