// What a fluid with a free surface does besides.
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "liquid/surface/surface_tension.hpp"
#include "liquid/surface/wet_bodies.hpp"
#include "mac/mac_fluid.hpp"
#include "mac/pressure/extended_pressure.hpp"

namespace lockstep {

template <int dim>
void MacFluid<dim>::move_liquid(double time, double dt, const MovingSurface<dim>& surface,
                                FaceField<dim>& advection) {
  const auto open = [this](int axis, int cell) {
    return geometry_.state.faces[axis][cell] == FaceState::coupled
               ? 0
               : geometry_.face_table(axis, cell).open;
  };
  const InterfaceStep<dim> step{advection,
                                surface,
                                ray_halo_,
                                nearby_,
                                time,
                                dt,
                                scalars_.liquid_sources(time),
                                liquid_->sinks(),
                                parameters_.forces.uniform(),
                                open};
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
/// their length (Brackbill et al. 1992, without air); implicit, it is stable to some 12 times that:
/// beyond, waves reach deeper than the layer that is held back.
template <int dim>
double MacFluid<dim>::largest_stable_step() const {
  if (!liquid_)
    return 1e300;
  const double g = parameters_.forces.uniform().norm(), h = domain_.spacing();
  const double by_gravity = g > 0 ? std::sqrt(h / g) : 1e300;
  const double tension = liquid_->tension();
  if (tension == 0)
    return by_gravity;
  const double part = tension_is_implicit() ? 8 * 0.28 : 0.28;
  return std::min(by_gravity, part * std::sqrt(parameters_.density * h * h * h / tension));
}

template <int dim>
std::vector<WetBody<dim>> MacFluid<dim>::wet_bodies() const {
  return find_wet_bodies<dim>(domain_, geometry_, liquid_->interface().distance(),
                              parameters_.forces.gravity);
}

template <int dim>
void MacFluid<dim>::bound_pressure(CellField& pressure) const {
  const CellField& phi = liquid_->interface().distance();
  const double tension = accepted_step_ * liquid_->tension();
  const auto at_surface = [&](int wet, int dry, int axis, int end) {
    double value = geometry_.in_pocket(dry) ? pressure[dry] : 0;
    if (tension > 0) {
      const int face = end == 0 ? wet : dry;
      const double place = 1 / geometry_.face_table(axis, face).closeness;
      value += tension * curvature(domain_, phi, wet, axis, end, place);
    }
    return value;
  };
  bound_beside_void<dim>(domain_, geometry_, at_surface, pressure);
}

template <int dim>
void MacFluid<dim>::settle_gas() {
  GasPockets<dim>& gas = *liquid_->gas();
  gas.settle(liquid_->interface().distance());
  gas_faces_ = find_gas_faces(domain_, geometry_);
}

template <int dim>
template <typename Value>
std::vector<double> MacFluid<dim>::sum_of_pockets(const Value& value) const {
  std::vector<double> sums(gas_pockets().size(), 0);
  for (const GasFace& face : gas_faces_)
    sums[face.pocket] += value(face);
  sum_all(domain_.grid.comm(), sums.data(), static_cast<int>(sums.size()));
  return sums;
}

template <int dim>
void MacFluid<dim>::add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const {
  const auto values = rhs.getDataNonConst();
  for (const GasFace& face : gas_faces_)
    values[face.row] += face.coefficient * scaled_pressure[face.pocket];
}

template <int dim>
std::vector<double> MacFluid<dim>::gas_conductance() const {
  return sum_of_pockets([](const GasFace& face) { return face.coefficient; });
}

template <int dim>
std::vector<double> MacFluid<dim>::gas_rates() const {
  return sum_of_pockets([&](const GasFace& face) {
    return -face.outward * face.area * prediction_[face.face.axis][face.face.cell];
  });
}

template <int dim>
std::vector<double> MacFluid<dim>::gas_answer(const Vector& scaled_pressure) const {
  const auto pressure = scaled_pressure.getData();
  return sum_of_pockets([&](const GasFace& face) { return face.coefficient * pressure[face.row]; });
}

template <int dim>
Momentum<dim> MacFluid<dim>::gas_side_impulse(const std::vector<double>& scaled_pressure) const {
  return sum_over_ranks(push_of_sides<dim>(domain_, geometry_, scaled_pressure),
                        domain_.grid.comm());
}

template std::vector<WetBody<2>> MacFluid<2>::wet_bodies() const;
template std::vector<WetBody<3>> MacFluid<3>::wet_bodies() const;
template void MacFluid<2>::move_liquid(double, double, const MovingSurface<2>&, FaceField<2>&);
template void MacFluid<3>::move_liquid(double, double, const MovingSurface<3>&, FaceField<3>&);
template void MacFluid<2>::push_surface(double);
template void MacFluid<3>::push_surface(double);
template double MacFluid<2>::largest_stable_step() const;
template double MacFluid<3>::largest_stable_step() const;
template void MacFluid<2>::bound_pressure(CellField&) const;
template void MacFluid<3>::bound_pressure(CellField&) const;
template void MacFluid<2>::settle_gas();
template void MacFluid<3>::settle_gas();
template void MacFluid<2>::add_gas_push(const std::vector<double>&, Vector&) const;
template std::vector<double> MacFluid<2>::gas_conductance() const;
template std::vector<double> MacFluid<2>::gas_rates() const;
template std::vector<double> MacFluid<2>::gas_answer(const Vector&) const;
template Momentum<2> MacFluid<2>::gas_side_impulse(const std::vector<double>&) const;
template void MacFluid<3>::add_gas_push(const std::vector<double>&, Vector&) const;
template std::vector<double> MacFluid<3>::gas_conductance() const;
template std::vector<double> MacFluid<3>::gas_rates() const;
template std::vector<double> MacFluid<3>::gas_answer(const Vector&) const;
template Momentum<3> MacFluid<3>::gas_side_impulse(const std::vector<double>&) const;

}  // namespace lockstep
