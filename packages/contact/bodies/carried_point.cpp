#include "contact/bodies/carried_point.hpp"

namespace lockstep {

namespace {

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
std::array<Eigen::Matrix<double, dim, dim>, dim> carried_point(
    const std::array<Point<dim>, dim>& corners, const SurfacePoint<dim>& point,
    const Point<dim>& x) {
  const Frame<dim> frame = frame_of(corners);
  const Point<dim> arm = x - point.position;
  const double height = frame.normal.dot(arm);
  std::array<Eigen::Matrix<double, dim, dim>, dim> factors;
  for (int i = 0; i < dim; ++i) {
    const double weight = point.barycentric[i] + frame.gradient[i].dot(arm);
    factors[i] = weight * Eigen::Matrix<double, dim, dim>::Identity() -
                 height * frame.gradient[i] * frame.normal.transpose();
  }
  return factors;
}

template std::array<Eigen::Matrix<double, 2, 2>, 2> carried_point<2>(const std::array<Point<2>, 2>&,
                                                                     const SurfacePoint<2>&,
                                                                     const Point<2>&);
template std::array<Eigen::Matrix<double, 3, 3>, 3> carried_point<3>(const std::array<Point<3>, 3>&,
                                                                     const SurfacePoint<3>&,
                                                                     const Point<3>&);

}  // namespace lockstep
