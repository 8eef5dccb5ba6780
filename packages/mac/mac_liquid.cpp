// What a fluid with a free surface does besides.
#include <cmath>

#include "mac/liquid/surface_tension.hpp"
#include "mac/liquid/wet_bodies.hpp"
#include "mac/mac_fluid.hpp"

namespace lockstep {

template <int dim>
void MacFluid<dim>::move_liquid(double time, double dt, const MovingSurface<dim>& surface,
                                FaceField<dim>& advection) {
  const InterfaceStep<dim> step{
      advection,       surface, ray_halo_, nearby_, time, dt, scalars_.liquid_sources(time),
      liquid_->sinks()};
  liquid_->advance(step, geometry_, advection, velocity_);
}

template <int dim>
void MacFluid<dim>::push_surface(double dt) {
  const Momentum<dim> mine = lockstep::push_surface<dim>(domain_, geometry_, liquid_->surface(),
                                                         liquid_->tension(), dt, prediction_);
  surface_impulse_ = sum_over_ranks(mine, domain_.grid.comm());
}

/// Gravity and the shortest waves of a surface at rest: their pressure answers within a step up to
/// about 1.3 times sqrt(h / g). Of surface tension the shortest waves must not go over more than
/// their length (Brackbill et al. 1992, without air).
template <int dim>
double MacFluid<dim>::largest_stable_step() const {
  if (!liquid_)
    return 1e300;
  const double g = parameters_.forces.gravity.norm(), h = domain_.spacing();
  const double by_gravity = g > 0 ? std::sqrt(h / g) : 1e300;
  const double tension = liquid_->tension();
  return tension > 0
             ? std::min(by_gravity, 0.28 * std::sqrt(parameters_.density * h * h * h / tension))
             : by_gravity;
}

template <int dim>
std::vector<WetBody<dim>> MacFluid<dim>::wet_bodies() const {
  return find_wet_bodies<dim>(domain_, geometry_, liquid_->interface().distance(),
                              parameters_.forces.gravity);
}

template std::vector<WetBody<2>> MacFluid<2>::wet_bodies() const;
template std::vector<WetBody<3>> MacFluid<3>::wet_bodies() const;
template void MacFluid<2>::move_liquid(double, double, const MovingSurface<2>&, FaceField<2>&);
template void MacFluid<3>::move_liquid(double, double, const MovingSurface<3>&, FaceField<3>&);
template void MacFluid<2>::push_surface(double);
template void MacFluid<3>::push_surface(double);
template double MacFluid<2>::largest_stable_step() const;
template double MacFluid<3>::largest_stable_step() const;

}  // namespace lockstep
