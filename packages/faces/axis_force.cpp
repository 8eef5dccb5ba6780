#include "faces/axis_force.hpp"

#include <Tpetra_Vector.hpp>

namespace lockstep {
namespace {

/// The surface point in the middle of a simplex.
template <int dim>
SurfacePoint<dim> middle(const SurfaceSnapshot<dim>& surface, int simplex) {
  SurfacePoint<dim> point;
  point.simplex = simplex;
  point.barycentric.setConstant(1. / dim);
  for (const Point<dim>& corner : surface.corners(simplex))
    point.position += corner / dim;
  return point;
}

/// Adds scale times the row of a point, taken at x.
template <int dim>
void add_row(const SolidSystem<dim>& solids, const SurfacePoint<dim>& point, const Point<dim>& x,
             double scale, AxisForce& force) {
  VelocityRow<dim> row;
  solids.velocity_row(point, x, row);
  for (std::size_t k = 0; k < row.dofs.size(); ++k) {
    force.dofs.push_back(row.dofs[k]);
    force.values.push_back(scale * row.coefficients[k][force.axis]);
  }
}

}  // namespace

template <int dim>
AxisForce force_of(const DisplacedExcess<dim>& excess, const SolidSystem<dim>& solids,
                   const SurfaceSnapshot<dim>& surface) {
  const SolidDescription& solid = surface.solids()[excess.solid];
  const Point<dim>& center = excess.center;
  AxisForce force;
  force.axis = excess.axis;
  if (solid.rigid) {
    const SurfacePoint<dim> point = middle<dim>(surface, solid.simplex_begin);
    const double length = surface.bounds(solid.simplex_begin).diagonal().norm();
    const double strength = excess.moment.norm() / length;
    add_row<dim>(solids, point, center, excess.mass, force);
    if (strength > 0) {  // a couple: rows of a rigid body are linear in x
      add_row<dim>(solids, point, center + excess.moment / strength, strength, force);
      add_row<dim>(solids, point, center, -strength, force);
    }
    return force;
  }
  double total = 0;
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s)
    total += area_vector<dim>(surface.corners(s)).norm();
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    const SurfacePoint<dim> point = middle<dim>(surface, s);
    const double share = area_vector<dim>(surface.corners(s)).norm() / total;
    add_row<dim>(solids, point, point.position, excess.mass * share, force);
  }
  return force;
}

template <int dim>
void add_forces(const std::vector<AxisForce>& forces, const Point<dim>& acceleration, double dt,
                Vector& momentum) {
  const RCP<const Map> map = momentum.getMap();
  for (const AxisForce& force : forces) {
    for (std::size_t k = 0; k < force.dofs.size(); ++k) {
      if (map->isNodeGlobalElement(force.dofs[k]))
        momentum.sumIntoGlobalValue(force.dofs[k], acceleration[force.axis] * dt * force.values[k]);
    }
  }
}

template <int dim>
std::vector<Momentum<dim>> impulses_on(std::size_t n_solids,
                                       const std::vector<DisplacedExcess<dim>>& excesses,
                                       const Point<dim>& acceleration, double dt) {
  std::vector<Momentum<dim>> impulses(n_solids);
  for (const DisplacedExcess<dim>& excess : excesses) {
    const Point<dim> speed = Point<dim>::Unit(excess.axis) * (acceleration[excess.axis] * dt);
    impulses[excess.solid].add(excess.center, excess.mass * speed);
    impulses[excess.solid].angular += cross<dim>(excess.moment, speed);
  }
  return impulses;
}

template std::vector<Momentum<2>> impulses_on<2>(std::size_t,
                                                 const std::vector<DisplacedExcess<2>>&,
                                                 const Point<2>&, double);
template std::vector<Momentum<3>> impulses_on<3>(std::size_t,
                                                 const std::vector<DisplacedExcess<3>>&,
                                                 const Point<3>&, double);
template AxisForce force_of<2>(const DisplacedExcess<2>&, const SolidSystem<2>&,
                               const SurfaceSnapshot<2>&);
template AxisForce force_of<3>(const DisplacedExcess<3>&, const SolidSystem<3>&,
                               const SurfaceSnapshot<3>&);
template void add_forces<2>(const std::vector<AxisForce>&, const Point<2>&, double, Vector&);
template void add_forces<3>(const std::vector<AxisForce>&, const Point<3>&, double, Vector&);

}  // namespace lockstep
