#include "mac/parts/mac_gas.hpp"

#include <Tpetra_Vector.hpp>

#include "mac/pressure/pressure_system.hpp"

namespace lockstep {

template <int dim>
void MacGas<dim>::settle() {
  bubbles_.settle(flow_.liquid->interface().distance());
  faces_ = find_gas_faces(flow_.domain, flow_.geometry);
}

template <int dim>
void MacGas<dim>::project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) {
  CellField pressure = pressure_field(flow_.domain, flow_.geometry, scaled_pressure);
  bubbles_.fill(gas_pressure, pressure);
  flow_.project(std::move(pressure));
}

template <int dim>
template <typename Value>
std::vector<double> MacGas<dim>::sum_of_bubbles(const Value& value) const {
  std::vector<double> sums(gas_bubbles().size(), 0);
  for (const GasFace& face : faces_)
    sums[face.bubble] += value(face);
  sum_over_ranks(flow_.domain.grid.comm(), sums);
  return sums;
}

template <int dim>
void MacGas<dim>::add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const {
  const auto values = rhs.getDataNonConst();
  for (const GasFace& face : faces_)
    values[face.row] += face.coefficient * scaled_pressure[face.bubble];
}

template <int dim>
std::vector<double> MacGas<dim>::gas_conductance() const {
  return sum_of_bubbles([](const GasFace& face) { return face.coefficient; });
}

template <int dim>
std::vector<double> MacGas<dim>::gas_rates() const {
  return sum_of_bubbles([&](const GasFace& face) {
    return -face.outward * face.area * flow_.prediction[face.face.axis][face.face.cell];
  });
}

template <int dim>
std::vector<double> MacGas<dim>::gas_answer(const Vector& scaled_pressure) const {
  const auto pressure = scaled_pressure.getData();
  return sum_of_bubbles([&](const GasFace& face) { return face.coefficient * pressure[face.row]; });
}

template <int dim>
Momentum<dim> MacGas<dim>::gas_side_impulse(const std::vector<double>& scaled_pressure) const {
  return sum_over_ranks(push_of_sides<dim>(flow_.domain, flow_.geometry, scaled_pressure),
                        flow_.domain.grid.comm());
}

template class MacGas<2>;
template class MacGas<3>;

}  // namespace lockstep
