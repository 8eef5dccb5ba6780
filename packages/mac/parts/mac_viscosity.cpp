#include "mac/parts/mac_viscosity.hpp"

#include "mac/parts/mac_audit.hpp"

namespace lockstep {

namespace {
/// With phi where there is a gas.
template <int dim>
ViscosityParameters present_parameters(const MacFlow<dim>& flow) {
  ViscosityParameters parameters = flow.parameters.viscosity;
  const Phases& phases = flow.parameters.phases;
  if (phases.gas && parameters.viscosity > 0)
    parameters.phases = {phases.liquid.viscosity / parameters.viscosity,
                         phases.gas->viscosity / parameters.viscosity,
                         &flow.liquid->interface().distance()};
  return parameters;
}
}  // namespace

template <int dim>
void MacViscosity<dim>::renew() {
  if (flow_.parameters.viscosity.viscosity > 0 && !flow_.tension_is_implicit())
    viscosity_ =
        std::make_unique<Viscosity<dim>>(flow_.domain, flow_.geometry, present_parameters(flow_));
}

template <int dim>
void MacViscosity<dim>::renew_tension(double dt) {
  if (!flow_.tension_is_implicit())
    return;
  const ImplicitTension implicit{dt * flow_.liquid->tension(),
                                 &flow_.liquid->interface().distance()};
  viscosity_ = std::make_unique<Viscosity<dim>>(flow_.domain, flow_.geometry,
                                                present_parameters(flow_), implicit);
}

template <int dim>
Momentum<dim> MacViscosity<dim>::accept_viscous(const Vector& solution, const Vector& velocity,
                                                double dt) {
  const auto now = [&](int axis, int cell) { return flow_.prediction[axis][cell]; };
  Momentum<dim> shifts;
  shifts.angular = -moment_of_shifts<dim>(flow_.geometry, now);
  viscosity_->store(solution, flow_.prediction);
  flow_.domain.halo.fill(flow_.prediction);
  Momentum<dim> impulse = viscosity_->impulse(flow_.prediction, flow_.time, dt);
  if (flow_.tension_is_implicit()) {
    const Momentum<dim> implicit = viscosity_->tension_impulse(flow_.prediction, dt);
    flow_.surface_impulse += implicit;
    impulse += implicit;
  }
  viscosity_->store(velocity, flow_.prediction);
  flow_.domain.halo.fill(flow_.prediction);
  // The scheme's forces act at the faces' centres, the momentum counts where the fluid is.
  shifts.angular += moment_of_shifts<dim>(flow_.geometry, now);
  return impulse + sum_over_ranks(shifts, flow_.domain.grid.comm());
}

template class MacViscosity<2>;
template class MacViscosity<3>;

}  // namespace lockstep
