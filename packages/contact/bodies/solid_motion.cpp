#include "contact/bodies/solid_motion.hpp"

#include "contact/bodies/carried_point.hpp"

namespace lockstep {

namespace {
/// The displacement of the end of an arm that turns by `turn` [rad].
Point<2> swing(const AngularVector<2>& turn, const Point<2>& arm) {
  return Eigen::Rotation2Dd(turn[0]) * arm - arm;
}
Point<3> swing(const AngularVector<3>& turn, const Point<3>& arm) {
  const double angle = turn.norm();
  if (angle == 0)
    return Point<3>::Zero();
  return Eigen::AngleAxisd(angle, turn / angle) * arm - arm;
}

AngularVector<2> spin_of(const Eigen::Matrix2d& gradient) {
  return AngularVector<2>(gradient(1, 0));
}
AngularVector<3> spin_of(const Eigen::Matrix3d& gradient) {
  return {gradient(2, 1), gradient(0, 2), gradient(1, 0)};
}
}  // namespace

template <int dim>
Point<dim> point_velocity(const ContactShapes<dim>& shapes, bool prescribed,
                          const SurfacePoint<dim>& point, const Point<dim>& x,
                          const std::vector<double>& velocity) {
  if (prescribed)
    return shapes.prescribed_velocity(point, x);
  VelocityRow<dim> row;
  shapes.velocity_row(point, x, row);
  Point<dim> sum = shapes.constraint_error(point, x);
  for (std::size_t k = 0; k < row.dofs.size(); ++k)
    sum += velocity[row.dofs[k]] * row.coefficients[k];
  return sum;
}

/// Returns the centres about which rigid solids turn; zero for others.
template <int dim>
std::vector<Point<dim>> centers_of(const SolidSystem<dim>& system) {
  std::vector<Point<dim>> centers(system.solids().size(), Point<dim>::Zero());
  std::vector<SolidState<dim>> states;
  for (std::size_t i = 0; i < centers.size(); ++i) {
    const SolidDescription& solid = system.solids()[i];
    if (!solid.rigid)
      continue;
    if (const auto* framed = system.model(solid.model).jointable()) {
      centers[i] = framed->rigid_frame(solid.index_in_model).position;
      continue;
    }
    if (states.empty())
      states = system.states();
    centers[i] = states[i].center_of_mass;
  }
  return centers;
}

template <int dim>
SolidMotion<dim>::SolidMotion(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                              const std::vector<double>& velocity)
    : shapes_(shapes), motions_(shapes.n_solids()) {
  const std::vector<Point<dim>> centers = centers_of(system);
  for (int i = 0; i < shapes.n_solids(); ++i) {
    const SolidDescription& solid = shapes.solids()[i];
    Motion& motion = motions_[i];
    const bool has_surface = solid.simplex_begin < solid.simplex_end;
    if (!has_surface && !shapes.carries(i))
      continue;
    const Box<dim>& box = shapes.bounds_of_solid(i);
    motion.rigid = solid.rigid;
    if (!motion.rigid) {
      vertex_velocities_.resize(shapes.mesh().vertices.size(), Point<dim>::Zero());
      for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
        const SurfacePoint<dim> point = shapes.at_vertex(v);
        if (point.simplex < 0)
          continue;
        vertex_velocities_[v] =
            point_velocity(shapes, solid.prescribed, point, point.position, velocity);
        motion.range.extend(vertex_velocities_[v]);
      }
      continue;
    }
    SurfacePoint<dim> point;
    point.simplex = solid.simplex_begin;
    point.barycentric.fill(1.0 / dim);
    motion.center = centers[shapes.source(i)] + shapes.shift(i);
    const auto field = [&](const Point<dim>& x) {
      return solid.prescribed ? shapes.prescribed_velocity(point, x)
                              : shapes.rigid_velocity(i, x, velocity);
    };
    motion.velocity = field(motion.center);
    // Rows are those of the nearest image: an arm stays well within half a period.
    const double arm = has_surface ? box.diagonal().norm() *
                                         (system.repeated().includes(shapes.source(i)) ? 0.25 : 1)
                                   : 1;
    for (int a = 0; a < dim; ++a) {
      motion.gradient.col(a) =
          (field(motion.center + arm * Point<dim>::Unit(a)) - motion.velocity) / arm;
    }
    for (int corner = 0; has_surface && corner < (1 << dim); ++corner) {
      const Point<dim> x = box.corner(static_cast<typename Box<dim>::CornerType>(corner));
      motion.range.extend(Point<dim>(motion.velocity + motion.gradient * (x - motion.center)));
    }
  }
}

template <int dim>
Point<dim> SolidMotion<dim>::at(int solid, const SurfacePoint<dim>& point,
                                const Point<dim>& x) const {
  const Motion& motion = motions_[solid];
  if (motion.rigid)
    return motion.velocity + motion.gradient * (x - motion.center);
  const auto factors = carried_point<dim>(shapes_.corners(point.simplex), point, x);
  Point<dim> sum = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    sum += factors[k] * vertex_velocities_[shapes_.mesh().simplices[point.simplex][k]];
  return sum;
}

template <int dim>
Point<dim> SolidMotion<dim>::of_vertex(int solid, int vertex) const {
  const Motion& motion = motions_[solid];
  if (motion.rigid)
    return motion.velocity + motion.gradient * (shapes_.mesh().vertices[vertex] - motion.center);
  return vertex_velocities_[vertex];
}

template <int dim>
Point<dim> SolidMotion<dim>::end_of_point(int rigid_solid, const Point<dim>& x, double dt) const {
  const Motion& motion = motions_[rigid_solid];
  const AngularVector<dim> turn = dt * spin_of(motion.gradient);
  return x + dt * motion.velocity + swing(turn, Point<dim>(x - motion.center));
}

template <int dim>
AngularVector<dim> SolidMotion<dim>::spin(int rigid_solid) const {
  return spin_of(motions_[rigid_solid].gradient);
}

template <int dim>
Point<dim> SolidMotion<dim>::end_of_vertex(int solid, int vertex, double dt) const {
  const Point<dim>& x = shapes_.mesh().vertices[vertex];
  const int rigid = motions_[solid].rigid ? solid : shapes_.carrier(vertex);
  if (rigid >= 0)
    return end_of_point(rigid, x, dt);
  const Point<dim> end = x + dt * vertex_velocities_[vertex];
  if (!shapes_.has_drift())
    return end;
  const SurfacePoint<dim> point = shapes_.at_vertex(vertex);
  return point.simplex < 0 ? end : Point<dim>(end + dt * shapes_.drift(point, x));
}

template class SolidMotion<2>;
template class SolidMotion<3>;
template Point<2> point_velocity<2>(const ContactShapes<2>&, bool, const SurfacePoint<2>&,
                                    const Point<2>&, const std::vector<double>&);
template Point<3> point_velocity<3>(const ContactShapes<3>&, bool, const SurfacePoint<3>&,
                                    const Point<3>&, const std::vector<double>&);

}  // namespace lockstep
