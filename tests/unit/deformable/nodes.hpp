#pragma once
#include <Eigen/Core>
#include <random>
#include <vector>

#include "deformable/elements/node_matrix.hpp"

namespace lockstep::test {

template <int dim>
using Nodes = std::vector<Point<dim>>;

/// Stretched, then each coordinate moved at random by at most the amplitude.
template <int dim>
Nodes<dim> shaken(Nodes<dim> x, double stretch, double amplitude, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-amplitude, amplitude);
  for (auto& point : x) {
    for (int a = 0; a < dim; ++a)
      point[a] = stretch * point[a] + number(random);
  }
  return x;
}

template <int dim>
Eigen::MatrixXd dense_blocks(const NodeMatrix<dim>& matrix) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(dim * matrix.n_rows(), dim * matrix.n_rows());
  for (int row = 0; row < matrix.n_rows(); ++row) {
    for (int k = matrix.row_begin(row); k < matrix.row_end(row); ++k)
      result.block<dim, dim>(dim * row, dim * matrix.column(k)) = matrix.block(k);
  }
  return result;
}

}  // namespace lockstep::test
