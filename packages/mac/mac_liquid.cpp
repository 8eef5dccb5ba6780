// What a fluid with a free surface does besides.
#include <cmath>

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

/// Gravity and the shortest waves of a surface at rest: their pressure answers within a step up to
/// about 1.3 times this one.
template <int dim>
double MacFluid<dim>::largest_stable_step() const {
  const double g = parameters_.forces.gravity.norm();
  return liquid_ && g > 0 ? std::sqrt(domain_.spacing() / g) : 1e300;
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
template double MacFluid<2>::largest_stable_step() const;
template double MacFluid<3>::largest_stable_step() const;

}  // namespace lockstep
