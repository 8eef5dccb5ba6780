#pragma once
#include <string>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

template <int dim>
using Axes = Eigen::Matrix<double, dim, dim>;

/// Pose of the second side of a joint in the axes of the first; the joint's own axis comes first.
template <int dim>
struct RelativePose {
  Point<dim> offset = Point<dim>::Zero();  ///< [m]
  Axes<dim> rotation = Axes<dim>::Identity();
};

/// A motion of the second side against the first, or a force and a torque between them: along the
/// axes of the first side, at the point of the second.
template <int dim>
struct Screw {
  Point<dim> linear = Point<dim>::Zero();
  AngularVector<dim> angular = AngularVector<dim>::Zero();
};

/// Axes about which a joint turns: two_axes are the first of the first side and the second of the
/// second side.
enum class JointTurn { none, axis, two_axes, any };

/// The degrees of freedom of a joint. Its coordinates q are displacements along the axes it
/// slides on, then angles: about the axis, about the two axes one after the other, or a rotation
/// vector.
struct JointKind {
  std::string name;
  std::vector<int> slides;  ///< axes
  JointTurn turn = JointTurn::none;
};

/// All kinds, with one line on each.
struct DescribedKind {
  JointKind kind;
  std::string documentation;
};
template <int dim>
std::vector<DescribedKind> joint_kinds();

template <int dim>
int n_rates(const JointKind& kind);
/// True if a joint has several coordinates with a meaning one by one, unlike those of a rotation
/// vector.
template <int dim>
bool has_separate_coordinates(const JointKind& kind);

/// The motions that its rates stand for, one a rate.
template <int dim>
std::vector<Screw<dim>> free_screws(const JointKind& kind, const RelativePose<dim>& pose);
/// Rows that read the rates off a motion that the joint lets go; a unit force or torque along each.
template <int dim>
std::vector<Screw<dim>> rate_rows(const JointKind& kind, const RelativePose<dim>& pose);
/// Rows that every motion it lets go makes zero.
template <int dim>
std::vector<Screw<dim>> held_rows(const JointKind& kind, const RelativePose<dim>& pose);

/// Distances of the sides from a place that the joint allows [m, rad]: one for each of `held_rows`,
/// whose values are their rates of change where they are zero.
template <int dim>
Eigen::VectorXd gap(const JointKind& kind, const RelativePose<dim>& pose);
/// q of a pose without gap. Angles are those nearest to `near`, whole turns included.
template <int dim>
Eigen::VectorXd coordinates(const JointKind& kind, const RelativePose<dim>& pose,
                            const Eigen::VectorXd& near);
template <int dim>
RelativePose<dim> pose_of(const JointKind& kind, const Eigen::VectorXd& q);
/// q after a motion by `change`, rates times dt.
template <int dim>
Eigen::VectorXd advanced(const JointKind& kind, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& change);
/// Returns the change with which `advanced` takes q to `goal`; for ball joints with the same number
/// of whole turns.
template <int dim>
Eigen::VectorXd change_to(const JointKind& kind, const Eigen::VectorXd& q,
                          const Eigen::VectorXd& goal);
/// Change of the coordinates that leads from a pose to q, to first order.
template <int dim>
Eigen::VectorXd distance_to(const JointKind& kind, const RelativePose<dim>& pose,
                            const Eigen::VectorXd& q);

}  // namespace lockstep
