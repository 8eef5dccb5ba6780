#pragma once
#include "contact/bodies/contact_side.hpp"
#include "contact/impulses/coulomb.hpp"
#include "contact/search/contact_search.hpp"

namespace lockstep {

/// A contact that impulses are sought for, with its frame: the normal first, then the tangents.
template <int dim>
struct ContactRow {
  using Compliance = Eigen::Matrix<double, dim, dim>;

  Contact<dim> contact;
  int begin = 0, end = 0;                      ///< its weights by dof, in a list for all contacts
  int response_begin = 0, response_end = 0;    ///< M_S^-1 J^T likewise, without a response
  Point<dim> prescribed = Point<dim>::Zero();  ///< velocity that no impulse changes [m/s]
  Point<dim> of_given = Point<dim>::Zero();    ///< its part of prescribed solids and walls
  double target = 0;                           ///< least normal velocity [m/s]
  double normal_response = 0, tangent_response = 0;  ///< velocity per impulse [1/kg]
  bool solid_prescribed = false, other_prescribed = false;
  Compliance frame = Compliance::Zero();      ///< by columns
  CoulombContact<dim> law;                    ///< in the frame
  Point<dim> impulse = Point<dim>::Zero();    ///< in the frame [kg m/s]
  Point<dim> change = Point<dim>::Zero();     ///< by the last sweep, in the frame
  Point<dim> direction = Point<dim>::Zero();  ///< last one of conjugate gradients, in the frame

  bool pushes() const { return impulse[0] > 0; }
  /// True at the edge of Coulomb's cone, and without friction.
  bool slides() const {
    constexpr double edge = 1 - 1e-9;
    return impulse.template tail<dim - 1>().norm() >= edge * law.friction * impulse[0];
  }
  /// The impulse of friction, in space.
  Point<dim> of_friction() const {
    return frame.template rightCols<dim - 1>() * impulse.template tail<dim - 1>();
  }
  ContactSide<dim> solid_side() const { return {contact.solid, contact.point, contact.place()}; }
  ContactSide<dim> other_side() const {
    return {contact.other, contact.other_point, contact.other_place()};
  }
};

}  // namespace lockstep
