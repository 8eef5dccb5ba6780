#include "geometry/surface_mesh.hpp"

namespace lockstep {

namespace {

/// Sums of measure, first and second moments over simplices.
template <int dim>
struct Moments {
  double measure = 0;
  Point<dim> first = Point<dim>::Zero();
  Eigen::Matrix<double, dim, dim> second = Eigen::Matrix<double, dim, dim>::Zero();

  /// A simplex of n corners has int x x^T = measure / (n (n + 1)) (S S^T + sum v v^T), S = sum v.
  template <std::size_t n>
  void add(const std::array<Point<dim>, n>& corners, double simplex_measure) {
    Point<dim> sum = Point<dim>::Zero();
    Eigen::Matrix<double, dim, dim> squares = Eigen::Matrix<double, dim, dim>::Zero();
    for (const Point<dim>& v : corners) {
      sum += v;
      squares += v * v.transpose();
    }
    measure += simplex_measure;
    first += simplex_measure / n * sum;
    second += simplex_measure / (n * (n + 1)) * (sum * sum.transpose() + squares);
  }
};

template <int dim>
MassProperties<dim> properties_of(const Moments<dim>& moments, const Point<dim>& origin) {
  MassProperties<dim> properties;
  properties.measure = moments.measure;
  if (moments.measure == 0) {
    properties.centroid = origin;
    return properties;
  }
  const Point<dim> arm = moments.first / moments.measure;
  const Eigen::Matrix<double, dim, dim> central =
      moments.second - moments.measure * arm * arm.transpose();
  properties.centroid = origin + arm;
  if constexpr (dim == 2) {
    properties.inertia(0, 0) = central.trace();
  } else {
    properties.inertia = central.trace() * Eigen::Matrix3d::Identity() - central;
  }
  return properties;
}

/// A point near the surface: moments about it lose no digits for a body far from the origin.
template <int dim>
Point<dim> mean_vertex(const SurfaceMesh<dim>& mesh) {
  Point<dim> mean = Point<dim>::Zero();
  for (const Point<dim>& v : mesh.vertices)
    mean += v / static_cast<double>(mesh.vertices.size());
  return mean;
}

template <int dim>
std::array<Point<dim>, dim> corners_about(const SurfaceMesh<dim>& mesh,
                                          const std::array<int, dim>& simplex,
                                          const Point<dim>& origin) {
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k)
    corners[k] = mesh.vertices[simplex[k]] - origin;
  return corners;
}

}  // namespace

template <int dim>
MassProperties<dim> volume_properties(const SurfaceMesh<dim>& mesh) {
  const Point<dim> origin = mean_vertex(mesh);
  Moments<dim> moments;
  for (const auto& simplex : mesh.simplices) {
    const auto corners = corners_about<dim>(mesh, simplex, origin);
    std::array<Point<dim>, dim + 1> cone;
    std::copy(corners.begin(), corners.end(), cone.begin());
    cone[dim].setZero();
    moments.add(cone, area_vector<dim>(corners).dot(corners[0]) / dim);
  }
  return properties_of<dim>(moments, origin);
}

template <int dim>
MassProperties<dim> shell_properties(const SurfaceMesh<dim>& mesh) {
  const Point<dim> origin = mean_vertex(mesh);
  Moments<dim> moments;
  for (const auto& simplex : mesh.simplices) {
    const auto corners = corners_about<dim>(mesh, simplex, origin);
    moments.add(corners, area_vector<dim>(corners).norm());
  }
  return properties_of<dim>(moments, origin);
}

template MassProperties<2> volume_properties<2>(const SurfaceMesh<2>&);
template MassProperties<3> volume_properties<3>(const SurfaceMesh<3>&);
template MassProperties<2> shell_properties<2>(const SurfaceMesh<2>&);
template MassProperties<3> shell_properties<3>(const SurfaceMesh<3>&);

}  // namespace lockstep
