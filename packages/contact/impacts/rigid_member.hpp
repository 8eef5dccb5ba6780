#pragma once
#include <vector>

#include "contact/bodies/contact_shapes.hpp"
#include "contact/bodies/inverse_mass.hpp"

namespace lockstep {

/// The velocity of a point, then an angular one.
template <int dim>
using MemberMotion = Eigen::Matrix<double, dim + n_rotations<dim>, 1>;
template <int dim>
using MemberMass = Eigen::Matrix<double, dim + n_rotations<dim>, dim + n_rotations<dim>>;

/// A dynamic rigid solid that is to move as one with others: maps between its dofs and twists.
/// Local.
template <int dim>
class RigidMember {
 public:
  /// `center`: what it turns about.
  RigidMember(const ContactShapes<dim>& shapes, const InverseMass& inverse_mass, int solid,
              const Point<dim>& center);

  const Point<dim>& center() const { return center_; }
  /// The solid's free dofs.
  const std::vector<GlobalIndex>& dofs() const { return dofs_; }
  /// Mass matrix for twists about `about`, and the momentum dual to these twists at given
  /// velocities.
  MemberMass<dim> mass(const Point<dim>& about) const;
  MemberMotion<dim> momentum(const Point<dim>& about, const std::vector<double>& velocity) const;
  /// Gives the solid this twist of its centre, or the nearest one that its dofs can make; returns
  /// false in that case.
  bool move(const MemberMotion<dim>& twist, std::vector<double>& velocity) const;

 private:
  Eigen::MatrixXd dofs_of_twists(const Point<dim>& about) const;

  const ContactShapes<dim>& shapes_;
  int solid_;
  Point<dim> center_;
  double arm_;  ///< [m]
  std::vector<GlobalIndex> dofs_;
  Eigen::MatrixXd rows_;     ///< velocities of the centre and of points beside it, of the dofs
  Eigen::MatrixXd inverse_;  ///< least dofs for such velocities
  Eigen::MatrixXd mass_;     ///< mass of the dofs
};

}  // namespace lockstep
