#pragma once
#include <vector>

#include "articulated/mechanism.hpp"

namespace lockstep {

/// Mass of a dynamic body at its present pose. Its reference point is its centre of mass.
template <int dim>
struct BodyMass {
  using Matrix = Eigen::Matrix<double, n_twist<dim>, n_twist<dim>>;
  Matrix matrix = Matrix::Zero(), inverse = Matrix::Zero();
};
template <int dim>
BodyMass<dim> mass_of(const typename BodyMass<dim>::Matrix& matrix);

/// Motion of a body in a step.
template <int dim>
struct BodyMotion {
  TwistVector<dim> momentum = TwistVector<dim>::Zero();  ///< with which it sets out
  TwistVector<dim> twist = TwistVector<dim>::Zero();     ///< the mean of the step
};

/// Bodies of a mechanism that are about to move.
template <int dim>
struct ClosingProblem {
  const Mechanism& mechanism;
  const std::vector<Joint<dim>>& joints;
  const std::vector<BodyPose<dim>>& poses;   ///< present poses of all bodies
  const std::vector<BodyPose<dim>>& ends;    ///< poses of prescribed bodies after the step
  const std::vector<BodyMass<dim>>& masses;  ///< masses of dynamic bodies
  double dt = 0;
};

/// Response of bodies to impulses: as free ones, whose mean twist is that of their momentum
/// (`free_twist`), or each twist just changes by M^-1 times the impulse.
enum class Answer { free, straight };

/// Adds impulses J^T lambda, with the joints' rows J at the present poses, so that all joints fit
/// after the move: Newton's method, the smallest impulse where joints are redundant. False, and
/// nothing changed, if there is no solution in reach. `motions`: by body. Local.
template <int dim>
bool close_joints(const ClosingProblem<dim>& problem, Answer answer,
                  std::vector<BodyMotion<dim>>& motions);

/// Removes from momenta the part that joints do not allow at the present poses, by impulses J^T mu.
template <int dim>
void let_joints_hold(const ClosingProblem<dim>& problem, std::vector<BodyMotion<dim>>& motions);

/// Mean twist over dt of a body that nothing acts on.
template <int dim>
TwistVector<dim> free_twist(const BodyMass<dim>& mass, const TwistVector<dim>& momentum, double dt);

/// Returns the twists that take the bodies to the poses given by the root's twist and the rates of
/// the tree's joints. `change`: rates times dt, of all joints. Local.
template <int dim>
void follow_rates(const ClosingProblem<dim>& problem, const Eigen::VectorXd& change,
                  std::vector<BodyMotion<dim>>& motions);

/// Returns the poses after the step of the bodies of a mechanism and of prescribed ones.
template <int dim>
std::vector<BodyPose<dim>> poses_after(const ClosingProblem<dim>& problem,
                                       const std::vector<BodyMotion<dim>>& motions);
/// Pose of a body after dt.
template <int dim>
BodyPose<dim> moved(const BodyPose<dim>& pose, const TwistVector<dim>& twist, double dt);
/// The twist that takes a body there in dt.
template <int dim>
TwistVector<dim> twist_to(const BodyPose<dim>& from, const BodyPose<dim>& to, double dt);

/// Largest distance of a body's joints from its middle [m]; 1 if all are there.
template <int dim>
double reach(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints);
/// The largest gap of a joint: of lengths in `unit` [m], of angles in rad.
template <int dim>
double largest_gap(const Joint<dim>& joint, const std::vector<BodyPose<dim>>& poses,
                   double unit = 1);

}  // namespace lockstep
