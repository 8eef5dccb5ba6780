#include "articulated/joint_promises.hpp"

#include <fmt/format.h>

#include "base/round_off.hpp"
#include "motion/rotation.hpp"

namespace lockstep {

namespace {

/// The pose after a small motion of the second side: along and about the axes of the first.
template <int dim>
RelativePose<dim> pushed(const RelativePose<dim>& pose, const Screw<dim>& screw, double by) {
  const AngularVector<dim> turn = by * screw.angular;
  return {pose.offset + by * screw.linear,
          rotation_of<dim>(turn).toRotationMatrix() * pose.rotation};
}

template <int dim>
double product(const Screw<dim>& row, const Screw<dim>& motion) {
  return row.linear.dot(motion.linear) + row.angular.dot(motion.angular);
}

template <int dim>
std::string wrong_size(const JointKind<dim>& kind, const RelativePose<dim>& pose) {
  const auto n = static_cast<std::size_t>(kind.n_rates());
  const std::size_t n_held = dim + n_rotations<dim> - n;
  if (kind.free_screws(pose).size() != n)
    return fmt::format("has {} free motions for {} coordinates", kind.free_screws(pose).size(), n);
  if (kind.held_rows(pose).size() != n_held)
    return fmt::format("has {} held rows and {} coordinates, together not {}",
                       kind.held_rows(pose).size(), n, n + n_held);
  if (static_cast<std::size_t>(kind.gap(pose).size()) != n_held)
    return fmt::format("has {} gaps for {} held rows", kind.gap(pose).size(), n_held);
  return "";
}

}  // namespace

template <int dim>
std::string broken_promise(const JointKind<dim>& kind, const Eigen::VectorXd& q) {
  constexpr double by = 1e-6, close = 1e-4;
  const RelativePose<dim> start = kind.pose_of(Eigen::VectorXd::Zero(kind.n_rates()));
  if (!start.offset.isZero(rounding::differences) ||
      !start.rotation.isIdentity(rounding::differences))
    return "has sides that differ where its coordinates are 0, as at the start";
  const RelativePose<dim> pose = kind.pose_of(q);
  if (const std::string wrong = wrong_size(kind, pose); !wrong.empty())
    return wrong;
  if (!kind.gap(pose).isZero(rounding::differences))
    return "has a gap at the pose of coordinates";
  const Eigen::VectorXd found = kind.coordinates(pose, q);
  if (found.size() != q.size() || !(found - q).isZero(rounding::differences))
    return "finds other coordinates in a pose than those that led there";
  const std::vector<Screw<dim>> free = kind.free_screws(pose), held = kind.held_rows(pose);
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    const Eigen::VectorXd way = -kind.distance_to(pushed(pose, free[k], by), q) / by;
    if (!(way - Eigen::VectorXd::Unit(q.size(), row)).isZero(close))
      return fmt::format("has a free motion {} that does not change coordinate {} alone", k + 1,
                         k + 1);
  }
  for (const Screw<dim>& one : held) {
    const double length = std::sqrt(product(one, one));
    const Eigen::VectorXd opened = kind.gap(pushed(pose, one, by)) / by;
    for (std::size_t r = 0; r < held.size(); ++r) {
      const double expected = product(held[r], one);
      const double size = std::sqrt(product(held[r], held[r])) * length;
      if (std::abs(opened[static_cast<Eigen::Index>(r)] - expected) > close * std::max(size, 1.))
        return fmt::format("has a gap {} whose rate of change is not held row {}", r + 1, r + 1);
    }
    for (std::size_t k = 0; k < free.size(); ++k) {
      if (std::abs(product(one, free[k])) > rounding::differences * std::max(length, 1.))
        return fmt::format("holds a motion that is free, {}", k + 1);
    }
  }
  return "";
}

template std::string broken_promise(const JointKind<2>&, const Eigen::VectorXd&);
template std::string broken_promise(const JointKind<3>&, const Eigen::VectorXd&);

}  // namespace lockstep
