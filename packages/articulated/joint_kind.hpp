#pragma once
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

/// Degrees of freedom of a type of joints. Its coordinates q are displacements, then angles.
struct JointFreedom {
  int displacements = 0, angles = 0;
  int axes = 0;                  ///< number of axes that a scene names: "Axis", then "Second Axis"
  bool rotation_vector = false;  ///< the angles are one, and have no meaning one by one

  int n_coordinates() const { return displacements + angles; }
  bool has_separate_coordinates() const { return n_coordinates() > 1 && !rotation_vector; }
};

/// Motions of the second side of a joint against the first: those that its type lets go, and those
/// that it holds. At q = 0 both sides have one pose. Local.
template <int dim>
class JointKind {
 public:
  virtual ~JointKind() = default;
  const JointFreedom& freedom() const { return freedom_; }
  int n_rates() const { return freedom_.n_coordinates(); }

  /// The motions that its rates stand for, one a rate.
  virtual std::vector<Screw<dim>> free_screws(const RelativePose<dim>& pose) const = 0;
  /// Rows that every motion it lets go makes zero, dim (dim + 1) / 2 less its rates.
  virtual std::vector<Screw<dim>> held_rows(const RelativePose<dim>& pose) const = 0;
  /// Distances of the sides from a place that the joint allows [m, rad]: one for each of
  /// `held_rows`, whose values are their rates of change where they are zero.
  virtual Eigen::VectorXd gap(const RelativePose<dim>& pose) const = 0;
  /// q of a pose without gap. Angles are those nearest to `near`, whole turns included.
  virtual Eigen::VectorXd coordinates(const RelativePose<dim>& pose,
                                      const Eigen::VectorXd& near) const = 0;
  virtual RelativePose<dim> pose_of(const Eigen::VectorXd& q) const = 0;

  /// q after a motion by `change`, rates times dt.
  virtual Eigen::VectorXd advanced(const Eigen::VectorXd& q, const Eigen::VectorXd& change) const {
    return q + change;
  }
  /// Returns the change with which `advanced` takes q to `goal`; for rotation vectors with the same
  /// number of whole turns.
  virtual Eigen::VectorXd change_to(const Eigen::VectorXd& q, const Eigen::VectorXd& goal) const {
    return goal - q;
  }
  /// Change of the coordinates that leads from a pose to q, to first order.
  virtual Eigen::VectorXd distance_to(const RelativePose<dim>& pose,
                                      const Eigen::VectorXd& q) const {
    return q - coordinates(pose, q);
  }

  /// Rows that read the rates off a motion that the joint lets go.
  std::vector<Screw<dim>> rate_rows(const RelativePose<dim>& pose) const;

 protected:
  explicit JointKind(const JointFreedom& freedom) : freedom_(freedom) {}
  JointKind(const JointKind&) = default;
  JointKind& operator=(const JointKind&) = default;

 private:
  JointFreedom freedom_;
};

/// The angle that differs from `angle` by whole turns and is nearest to `near` [rad].
double nearest_angle(double angle, double near);
/// The angle of a rotation about the first axis, from -pi to pi [rad].
double angle_about_first(const Axes<2>& rotation);
double angle_about_first(const Axes<3>& rotation);
/// Distances of the first axes of both sides along the second axis and the third [rad].
Eigen::VectorXd axis_gap(const Axes<2>& rotation);  ///< none
Eigen::VectorXd axis_gap(const Axes<3>& rotation);

}  // namespace lockstep
