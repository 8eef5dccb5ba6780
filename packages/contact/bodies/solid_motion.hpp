#pragma once
#include <vector>

#include "contact/bodies/contact_shapes.hpp"

namespace lockstep {

/// The velocity of every surface point for given generalized velocities: one affine field for a
/// rigid solid, vertex by vertex for others. Local, the same on all ranks.
template <int dim>
class SolidMotion {
 public:
  /// Solids without surface, but for those that carry nodes, have no motion. `velocity`: V_S by id
  /// of `SolidSystem::map`, without padding.
  SolidMotion(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
              const std::vector<double>& velocity);

  /// Velocity of x [m/s], a point of a rigid solid or one that the simplex of `point` carries along
  /// (see `carried_point`).
  Point<dim> at(int solid, const SurfacePoint<dim>& point, const Point<dim>& x) const;
  /// Velocity of a vertex [m/s].
  Point<dim> of_vertex(int solid, int vertex) const;
  /// Position of a vertex, or of a point fixed to a rigid solid, after dt [m]: straight on and with
  /// its drift, but on a rigid solid, or carried by one, with its turn about its reference point if
  /// it has one, else about its centre of mass.
  Point<dim> end_of_vertex(int solid, int vertex, double dt) const;
  Point<dim> end_of_point(int rigid_solid, const Point<dim>& x, double dt) const;
  /// Centre about which a rigid solid turns [m], and its angular velocity [rad/s].
  const Point<dim>& center(int rigid_solid) const { return motions_[rigid_solid].center; }
  AngularVector<dim> spin(int rigid_solid) const;
  /// Componentwise bounds of the velocity over the solid [m/s].
  const Box<dim>& range(int solid) const { return motions_[solid].range; }

 private:
  struct Motion {
    bool rigid = true;
    Point<dim> center, velocity;  ///< centre that it turns about, and the velocity there
    Eigen::Matrix<double, dim, dim> gradient;
    Box<dim> range;
  };

  const ContactShapes<dim>& shapes_;
  std::vector<Motion> motions_;
  std::vector<Point<dim>> vertex_velocities_;  ///< filled where solids are not rigid
};

/// v(x) of a point of a dynamic or a prescribed solid. Local.
template <int dim>
Point<dim> point_velocity(const ContactShapes<dim>& shapes, bool prescribed,
                          const SurfacePoint<dim>& point, const Point<dim>& x,
                          const std::vector<double>& velocity);

}  // namespace lockstep
