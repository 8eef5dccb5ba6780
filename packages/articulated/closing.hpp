#pragma once
#include <vector>

#include "articulated/mechanism.hpp"

namespace lockstep {

/// Bodies of a mechanism that are about to move by constant twists.
template <int dim>
struct ClosingProblem {
  const Mechanism& mechanism;
  const std::vector<Joint<dim>>& joints;
  const std::vector<BodyPose<dim>>& poses;  ///< of all bodies, at present
  const std::vector<BodyPose<dim>>& ends;   ///< of prescribed ones, after the step
  /// Inverse masses of the dynamic ones.
  const std::vector<Eigen::Matrix<double, n_twist<dim>, n_twist<dim>>>& inverse_masses;
  double dt = 0;
};

/// Adds M^-1 J^T lambda, with the joints' rows J at the present poses, so that all joints fit after
/// the move: Newton's method, the smallest correction where joints are redundant. False, and
/// nothing changed, if there is no solution in reach. `twists`: by body. Local.
template <int dim>
bool close_joints(const ClosingProblem<dim>& problem, std::vector<TwistVector<dim>>& twists);

/// The twists that take the bodies to where the root's twist and the rates of the tree's joints
/// take them. `change`: rates times dt, of all joints. Local.
template <int dim>
void follow_rates(const ClosingProblem<dim>& problem, const Eigen::VectorXd& change,
                  std::vector<TwistVector<dim>>& twists);

/// Where a body is after dt.
template <int dim>
BodyPose<dim> moved(const BodyPose<dim>& pose, const TwistVector<dim>& twist, double dt);
/// The twist that takes a body there in dt.
template <int dim>
TwistVector<dim> twist_to(const BodyPose<dim>& from, const BodyPose<dim>& to, double dt);

/// How far from the middle of a body its joints are at most; 1 if all are there [m].
template <int dim>
double reach(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints);
/// The largest gap of a joint: of lengths in `unit` [m], of angles in rad.
template <int dim>
double largest_gap(const Joint<dim>& joint, const std::vector<BodyPose<dim>>& poses,
                   double unit = 1);

}  // namespace lockstep
