#pragma once
#include <utility>
#include <vector>

#include "contact/bodies/contact_shapes.hpp"

namespace lockstep {

/// One of the two solids of a contact.
template <int dim>
struct ContactSide {
  int solid = -1;
  SurfacePoint<dim> point;
  Point<dim> x = Point<dim>::Zero();  ///< where the impulse acts [m]
};

/// A surface point that moves x by a factor of its own velocity.
template <int dim>
struct Carrier {
  SurfacePoint<dim> point;
  Eigen::Matrix<double, dim, dim> factor;
};

/// Returns the points that move x: x itself on a rigid solid, else the corners of its simplex
/// (`carried_point`).
template <int dim>
std::vector<Carrier<dim>> carriers_of(const ContactShapes<dim>& shapes,
                                      const ContactSide<dim>& side);

/// Generalized impulse, by dof, of an impulse [kg m/s] on a side: on the dofs of the surface
/// itself, combinations or not. Nothing of a prescribed solid. Local.
template <int dim>
std::vector<std::pair<GlobalIndex, double>> impulse_on(const SolidSystem<dim>& system,
                                                       const ContactShapes<dim>& shapes,
                                                       const ContactSide<dim>& side,
                                                       const Point<dim>& impulse);

}  // namespace lockstep
