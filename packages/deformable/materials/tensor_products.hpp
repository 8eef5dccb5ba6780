#pragma once
#include <Eigen/Dense>

#include "deformable/materials/material.hpp"

namespace lockstep {

/// The columns of a tensor one below the other.
template <int dim>
Eigen::Matrix<double, dim * dim, 1> stacked(const Tensor<dim>& a) {
  return Eigen::Map<const Eigen::Matrix<double, dim * dim, 1>>(a.data());
}

/// d det F / dF.
template <int dim>
Tensor<dim> cofactors(const Tensor<dim>& f) {
  Tensor<dim> result;
  if constexpr (dim == 2) {
    result << f(1, 1), -f(1, 0), -f(0, 1), f(0, 0);
  } else {
    for (int k = 0; k < 3; ++k)
      result.col(k) = f.col((k + 1) % 3).cross(f.col((k + 2) % 3));
  }
  return result;
}

/// The derivative of the cofactors applied to d.
template <int dim>
Tensor<dim> cofactor_change(const Tensor<dim>& f, const Tensor<dim>& d) {
  if constexpr (dim == 2) {
    return cofactors<2>(d);
  } else {
    Tensor<3> result;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      result.col(k) = d.col(i).cross(f.col(j)) + f.col(i).cross(d.col(j));
    }
    return result;
  }
}

/// The matrix of a linear map of tensors.
template <int dim, typename LinearMap>
TensorDerivative<dim> matrix_of(const LinearMap& map) {
  TensorDerivative<dim> result;
  for (int c = 0; c < dim * dim; ++c) {
    Tensor<dim> unit = Tensor<dim>::Zero();
    unit(c % dim, c / dim) = 1;
    result.col(c) = stacked<dim>(map(unit));
  }
  return result;
}

}  // namespace lockstep
