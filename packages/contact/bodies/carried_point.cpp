#include "contact/bodies/carried_point.hpp"

namespace lockstep {

namespace {

template <int dim>
using Factors = std::array<Eigen::Matrix<double, dim, dim>, dim>;

/// Gradients of the barycentric coordinates within the simplex, and its unit normal; zero for a
/// degenerate one.
template <int dim>
struct Frame {
  std::array<Point<dim>, dim> gradient;
  Point<dim> normal = Point<dim>::Zero();
};

Frame<2> frame_of(const std::array<Point<2>, 2>& corners) {
  Frame<2> frame;
  const Point<2> along = corners[1] - corners[0];
  const double square = along.squaredNorm();
  frame.gradient.fill(Point<2>::Zero());
  if (square > 0) {
    frame.gradient = {Point<2>(-along / square), Point<2>(along / square)};
    frame.normal = Point<2>(along.y(), -along.x()).normalized();
  }
  return frame;
}

Frame<3> frame_of(const std::array<Point<3>, 3>& corners) {
  Frame<3> frame;
  const Point<3> twice_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double square = twice_area.squaredNorm();
  frame.gradient.fill(Point<3>::Zero());
  if (square > 0) {
    for (int i = 0; i < 3; ++i)
      frame.gradient[i] = twice_area.cross(corners[(i + 2) % 3] - corners[(i + 1) % 3]) / square;
    frame.normal = twice_area.normalized();
  }
  return frame;
}

}  // namespace

template <int dim>
Factors<dim> linear_motion(const std::array<Point<dim>, dim>& corners,
                           const SurfacePoint<dim>& point, const Point<dim>& x) {
  const Frame<dim> frame = frame_of(corners);
  const Point<dim> arm = x - point.position;
  const double height = frame.normal.dot(arm);
  Factors<dim> factors;
  for (int i = 0; i < dim; ++i) {
    const double weight = point.barycentric[i] + frame.gradient[i].dot(arm);
    factors[i] = weight * Eigen::Matrix<double, dim, dim>::Identity() -
                 height * frame.gradient[i] * frame.normal.transpose();
  }
  return factors;
}

template <int dim>
Factors<dim> carried_point(const std::array<Point<dim>, dim>& corners,
                           const SurfacePoint<dim>& point, const Point<dim>& x) {
  Factors<dim> factors = linear_motion<dim>(corners, point, x);
  const Point<dim> rod = (x - point.position).stableNormalized();
  for (int i = 0; i < dim; ++i)
    factors[i] += rod * (point.barycentric[i] * rod.transpose() - rod.transpose() * factors[i]);
  return factors;
}

template Factors<2> linear_motion<2>(const std::array<Point<2>, 2>&, const SurfacePoint<2>&,
                                     const Point<2>&);
template Factors<3> linear_motion<3>(const std::array<Point<3>, 3>&, const SurfacePoint<3>&,
                                     const Point<3>&);
template Factors<2> carried_point<2>(const std::array<Point<2>, 2>&, const SurfacePoint<2>&,
                                     const Point<2>&);
template Factors<3> carried_point<3>(const std::array<Point<3>, 3>&, const SurfacePoint<3>&,
                                     const Point<3>&);

}  // namespace lockstep
