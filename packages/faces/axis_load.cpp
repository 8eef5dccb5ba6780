#include "faces/axis_load.hpp"

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

/// Adds an impulse along an axis at x, which the solid of a surface point takes.
template <int dim>
void add_impulse(const SolidSystem<dim>& solids, const SurfacePoint<dim>& point,
                 const Point<dim>& x, const Point<dim>& impulse, Vector& momentum) {
  VelocityRow<dim> row;
  solids.velocity_row(point, x, row);
  for (std::size_t k = 0; k < row.dofs.size(); ++k)
    if (momentum.getMap()->isNodeGlobalElement(row.dofs[k]))
      momentum.sumIntoGlobalValue(row.dofs[k], row.coefficients[k].dot(impulse));
}

template <int dim>
void add_load(const AxisLoad<dim>& load, const SolidSystem<dim>& solids,
              const SurfaceSnapshot<dim>& surface, double dt, Vector& momentum) {
  const SolidDescription& solid = surface.solids()[load.solid];
  const Point<dim> unit = dt * Point<dim>::Unit(load.axis);
  if (solid.rigid) {
    const SurfacePoint<dim> point = middle<dim>(surface, solid.simplex_begin);
    // Rows are those of the nearest image: an arm stays well within half a period.
    const double length = surface.own_bounds(load.solid).diagonal().norm() *
                          (surface.images().repeats(load.solid) ? 0.25 : 1);
    const double strength = load.moment.norm() / length;
    add_impulse<dim>(solids, point, load.center, load.force * unit, momentum);
    if (strength > 0) {  // a couple: rows of a rigid body are linear in x
      const Point<dim> arm = load.moment / strength;
      add_impulse<dim>(solids, point, load.center + arm, strength * unit, momentum);
      add_impulse<dim>(solids, point, load.center, -strength * unit, momentum);
    }
    return;
  }
  double area = 0;
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s)
    area += area_vector<dim>(surface.corners(s)).norm();
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    const SurfacePoint<dim> point = middle<dim>(surface, s);
    const double share = area_vector<dim>(surface.corners(s)).norm() / area;
    add_impulse<dim>(solids, point, point.position, share * load.force * unit, momentum);
  }
}

}  // namespace

template <int dim>
void add_loads(const std::vector<AxisLoad<dim>>& loads, const SolidSystem<dim>& solids,
               const SurfaceSnapshot<dim>& surface, double dt, Vector& momentum) {
  for (const AxisLoad<dim>& load : loads)
    if (!surface.solids()[load.solid].prescribed)
      add_load<dim>(load, solids, surface, dt, momentum);
}

template <int dim>
std::vector<Momentum<dim>> impulses_on_prescribed(const std::vector<AxisLoad<dim>>& loads,
                                                  const SurfaceSnapshot<dim>& surface, double dt) {
  std::vector<Momentum<dim>> impulses(surface.solids().size());
  for (const AxisLoad<dim>& load : loads) {
    if (!surface.solids()[load.solid].prescribed)
      continue;
    const Point<dim> unit = dt * Point<dim>::Unit(load.axis);
    impulses[load.solid].add(load.center, load.force * unit);
    impulses[load.solid].angular += cross<dim>(load.moment, unit);
  }
  return impulses;
}

template void add_loads<2>(const std::vector<AxisLoad<2>>&, const SolidSystem<2>&,
                           const SurfaceSnapshot<2>&, double, Vector&);
template void add_loads<3>(const std::vector<AxisLoad<3>>&, const SolidSystem<3>&,
                           const SurfaceSnapshot<3>&, double, Vector&);
template std::vector<Momentum<2>> impulses_on_prescribed<2>(const std::vector<AxisLoad<2>>&,
                                                            const SurfaceSnapshot<2>&, double);
template std::vector<Momentum<3>> impulses_on_prescribed<3>(const std::vector<AxisLoad<3>>&,
                                                            const SurfaceSnapshot<3>&, double);

}  // namespace lockstep
