#pragma once
#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// An array of n numbers of a validated list.
template <int n>
Eigen::Matrix<double, n, 1> vector_value(const ParameterList& list, const std::string& name) {
  const auto& values = list.get<ParameterArray<double>>(name);
  Eigen::Matrix<double, n, 1> result;
  for (int i = 0; i < n; ++i)
    result[i] = values[i];
  return result;
}

/// Rotations: a number in 2D, an array of three in 3D.
template <int dim>
void declare_rotation(ParameterList& list, const std::string& name, const std::string& doc) {
  if constexpr (dim == 2) {
    declare(list, name, 0.0, doc);
  } else {
    declare_vector(list, name, {0.0, 0.0, 0.0}, 3, doc);
  }
}
template <int dim>
AngularVector<dim> rotation_value(const ParameterList& list, const std::string& name) {
  if constexpr (dim == 2) {
    return AngularVector<2>(list.get<double>(name));
  } else {
    return vector_value<3>(list, name);
  }
}

}  // namespace lockstep
