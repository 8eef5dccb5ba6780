#include "articulated/joint_kind.hpp"

#include <Eigen/LU>
#include <cmath>

namespace lockstep {

/// Least squares: of all such rows those that are combinations of the motions. They differ from
/// others by held rows alone, so that it does not matter that lengths and angles are mixed.
template <int dim>
std::vector<Screw<dim>> JointKind<dim>::rate_rows(const RelativePose<dim>& pose) const {
  const std::vector<Screw<dim>> free = free_screws(pose);
  Eigen::MatrixXd motions(dim + n_rotations<dim>, free.size());
  for (std::size_t k = 0; k < free.size(); ++k)
    motions.col(static_cast<Eigen::Index>(k)) << free[k].linear, free[k].angular;
  const Eigen::MatrixXd products = motions.transpose() * motions;
  const Eigen::MatrixXd duals = motions * products.inverse();
  std::vector<Screw<dim>> rows(free.size());
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto dual = duals.col(static_cast<Eigen::Index>(k));
    rows[k] = {dual.template head<dim>(), dual.template tail<n_rotations<dim>>()};
  }
  return rows;
}

double nearest_angle(double angle, double near) {
  return near + std::remainder(angle - near, 2 * pi);
}

double angle_about_first(const Axes<2>& rotation) {
  return std::atan2(rotation(1, 0), rotation(0, 0));
}
double angle_about_first(const Axes<3>& rotation) {
  return std::atan2(rotation(2, 1), rotation(1, 1));
}

Eigen::VectorXd axis_gap(const Axes<2>&) {
  return {};
}
/// a x (rotated a), without its part along a.
Eigen::VectorXd axis_gap(const Axes<3>& rotation) {
  const Point<3> between = Point<3>::UnitX().cross(Point<3>(rotation.col(0)));
  return between.tail<2>();
}

template class JointKind<2>;
template class JointKind<3>;

}  // namespace lockstep
