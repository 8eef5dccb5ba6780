#include "mac/parts/mac_liquid.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

#include "liquid/surface/levels_at_solids.hpp"
#include "liquid/surface/surface_tension.hpp"
#include "mac/parts/grid_place.hpp"
#include "mac/pressure/extended_pressure.hpp"

namespace lockstep {

template <int dim>
std::vector<double> MacLiquid<dim>::surface_distances(const std::vector<Point<dim>>& points) const {
  const TiledGrid<dim>& grid = flow_.domain.grid;
  const SampleLattice<dim> lattice(grid);
  const CellField& phi = liquid_.interface().distance();
  constexpr double nothing_stored = 1e300;
  const std::size_t n = points.size();
  std::vector<double> values(n, nothing_stored);
  for (std::size_t p = 0; p < n; ++p) {
    const auto [cell, x] = place_of<dim>(grid, points[p]);
    if (cell < 0 || !grid.owned(cell))
      continue;
    const auto stencil = lattice.locate(cell_centers, x);
    values[p] = stencil.complete() ? interpolate<dim>(stencil, phi.data()) : phi[cell];
  }
  min_over_ranks(grid.comm(), values);
  return values;
}

template <int dim>
std::vector<WaterLevel> MacLiquid<dim>::levels_at_solids() const {
  FreeSurface<dim> surface;
  surface.distance = &liquid_.interface().distance();
  surface.gas_density = liquid_.gas_density();
  return find_levels_at_solids<dim>(flow_.domain, flow_.geometry, surface,
                                    flow_.parameters.forces.gravity);
}

template <int dim>
void MacLiquid<dim>::bound_pressure(CellField& pressure) const {
  const FreeSurface<dim> surface = liquid_.surface();
  const double tension = flow_.accepted_step * liquid_.tension();
  const auto at_surface = [&](int wet, int dry, int axis, int end) {
    double value = flow_.geometry.in_bubble(dry) ? pressure[dry] : 0;
    if (tension > 0) {
      const int face = end == 0 ? wet : dry;
      const double place = 1 / flow_.geometry.face_table(axis, face).distance_factor;
      value += tension * surface.curvature(wet, axis, end, place);
    }
    return value;
  };
  bound_beside_air<dim>(flow_.domain, flow_.geometry, at_surface, pressure);
}

template <int dim>
void MacLiquid<dim>::move(double time, double dt, const MovingSurface<dim>& surface,
                          FaceField<dim>& advection) {
  const auto open = [this](int axis, int cell) {
    return flow_.geometry.state.faces[axis][cell] == FaceState::coupled
               ? 0
               : flow_.geometry.face_table(axis, cell).open;
  };
  // The surface of a source recedes at its velocity, whatever pressure and fall make of it within a
  // step: it gives its width times its speed.
  if (flow_.scalars.sources_push(time)) {
    flow_.scalars.push(flow_.geometry, time, advection);
    flow_.domain.halo.fill(advection);
  }
  const InterfaceStep<dim> step{advection,
                                surface,
                                flow_.ray_halo,
                                flow_.nearby,
                                time,
                                dt,
                                flow_.scalars.liquid_sources(time),
                                liquid_.sinks(),
                                flow_.parameters.forces.uniform(),
                                open};
  liquid_.advance(step, flow_.geometry, advection, flow_.velocity);
}

template <int dim>
void MacLiquid<dim>::push_surface(double dt) {
  const Momentum<dim> mine = lockstep::push_surface<dim>(
      flow_.domain, flow_.geometry, liquid_.surface(), liquid_.tension(), dt, flow_.prediction);
  flow_.surface_impulse = sum_over_ranks(mine, flow_.domain.grid.comm());
}

/// Gravity and the shortest waves of a surface at rest: their pressure answers within a step up to
/// about 1.3 times sqrt(h / g). Of surface tension the shortest waves must not go over more than
/// their length (Brackbill et al. 1992); implicit, it is stable to some 12 times that:
/// beyond, waves reach deeper than the layer that is held back.
template <int dim>
StepBound MacLiquid<dim>::largest_stable_step() const {
  const double g = flow_.parameters.forces.uniform().norm(), h = flow_.domain.spacing();
  StepBound by_gravity;
  if (g > 0)
    by_gravity = {std::sqrt(h / g), "gravity waves"};
  const double tension = liquid_.tension();
  if (tension == 0)
    return by_gravity;
  const double density = flow_.parameters.density + liquid_.gas_density();
  StepBound by_tension{0.28 * std::sqrt(density * h * h * h / tension), "surface tension"};
  if (liquid_.tension_is_implicit())
    by_tension.dt *= 8;
  else
    by_tension.remedy =
        "\"Fluid/Free Surface/Time Integration\" = semi-implicit allows 8 times as much.";
  return shorter(by_gravity, by_tension);
}

template class MacLiquid<2>;
template class MacLiquid<3>;

}  // namespace lockstep
