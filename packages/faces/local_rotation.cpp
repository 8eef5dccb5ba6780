#include "faces/local_rotation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

namespace lockstep {

template <int dim>
LocalRotation<dim>::LocalRotation(const Box<dim>& box, double arm, std::vector<int> simplices,
                                  int solid, const SurfaceSnapshot<dim>& surface) {
  constexpr int most_widenings = 8;
  collect(simplices, solid, surface);
  Point<dim> margin = 0.125 * box.sizes();
  for (int attempt = 0; attempt < most_widenings && !invert(arm); ++attempt, margin *= 2) {
    surface.touching(Box<dim>(box.min() - margin, box.max() + margin), simplices);
    collect(simplices, solid, surface);
  }
  if (!invert(arm) && !invert(0)) {
    vertices_.clear();  // a needle or a point: it does not turn
    arms_.clear();
  }
}

template <int dim>
bool LocalRotation<dim>::invert(double arm) {
  constexpr double least_ratio = 1e-2;  // ratio of the moments of inertia [1]
  constexpr double most_amplified = 3;  // arm over the radius of gyration
  const Eigen::SelfAdjointEigenSolver<Inertia> eigen(inertia());
  const auto& moments = eigen.eigenvalues();
  const double largest = moments[n_rotations<dim> - 1];
  if (!(largest > 0) || moments[0] < least_ratio * largest ||
      std::pow(most_amplified, 2) * moments[0] < static_cast<double>(arms_.size()) * arm * arm)
    return false;
  inverse_ =
      eigen.eigenvectors() * moments.cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  return true;
}

template <int dim>
void LocalRotation<dim>::collect(const std::vector<int>& simplices, int solid,
                                 const SurfaceSnapshot<dim>& surface) {
  vertices_.clear();
  arms_.clear();
  std::set<int> seen;
  Point<dim> mean = Point<dim>::Zero();
  for (const int simplex : simplices) {
    if (surface.solid_of(simplex) != solid)
      continue;
    for (int k = 0; k < dim; ++k) {
      const int vertex = surface.mesh().simplices[simplex][k];
      if (!seen.insert(vertex).second)
        continue;
      vertices_.push_back({simplex, Barycentric<dim>::Unit(k), surface.mesh().vertices[vertex], 0});
      mean += vertices_.back().position;
    }
  }
  mean /= std::max<std::size_t>(vertices_.size(), 1);
  for (const auto& vertex : vertices_)
    arms_.push_back(vertex.position - mean);
}

template <int dim>
typename LocalRotation<dim>::Inertia LocalRotation<dim>::inertia() const {
  Inertia sum = Inertia::Zero();
  for (const Point<dim>& arm : arms_) {
    sum += arm.squaredNorm() * Inertia::Identity();
    if constexpr (dim == 3)
      sum -= arm * arm.transpose();
  }
  return sum;
}

template class LocalRotation<2>;
template class LocalRotation<3>;

}  // namespace lockstep
