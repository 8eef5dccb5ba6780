#pragma once
#include <string>
#include <vector>

#include "base/types.hpp"
#include "parameters/field_formula.hpp"

namespace lockstep {

template <typename T>
ParameterArray<T> filled_array(int n, T value) {
  return ParameterArray<T>(n, value);
}

/// The variables of a formula of the place: x, y, z [m], in 2D x, y.
template <int dim>
std::vector<std::string> place() {
  return dim == 2 ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
}

/// A vector of a validated list.
template <int dim>
Point<dim> point_value(const ParameterList& list, const std::string& name) {
  const auto& values = list.get<ParameterArray<double>>(name);
  Point<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = values[a];
  return x;
}

/// Gravity of a validated list "Fluid" at t = 0 [m/s^2].
template <int dim>
Point<dim> gravity_at_start(const ParameterList& fluid) {
  return FieldFormula<dim>(fluid, "Gravity", "Fluid").vector(Point<dim>::Zero(), 0);
}

}  // namespace lockstep
