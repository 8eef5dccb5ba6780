#pragma once
#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep::deformable_lists {

/// An array of n numbers of a validated list.
template <int n>
Eigen::Matrix<double, n, 1> vector_value(const ParameterList& list, const std::string& name) {
  const auto& values = list.get<ParameterArray<double>>(name);
  Eigen::Matrix<double, n, 1> result;
  for (int i = 0; i < n; ++i)
    result[i] = values[i];
  return result;
}

}  // namespace lockstep::deformable_lists
