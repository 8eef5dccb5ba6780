#include "mac/mac_fluid.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "mac/make_geometry.hpp"
#include "mac/parts/prescribed_sides.hpp"
#include "mac/pressure/extended_pressure.hpp"
#include "mac/pressure/pressure_system.hpp"
#include "staggered/state/face_moments.hpp"
#include "transport/uncovered_samples.hpp"

namespace lockstep {

template <int dim>
MacFluid<dim>::MacFluid(const ParameterList& fluid, const ParameterList& domain,
                        const Communicator& comm, const InterfaceRegistry<dim>* interfaces)
    : flow_(fluid, domain, comm, interfaces),
      tiles_(fluid, flow_),
      audit_(flow_),
      viscosity_(flow_),
      output_(flow_, tiles_),
      energy_(std::make_unique<MacEnergy<dim>>(flow_)) {
  if (flow_.liquid)
    liquid_ = std::make_unique<MacLiquid<dim>>(flow_);
  if (flow_.holds_gas())
    gas_ = std::make_unique<MacGas<dim>>(flow_);
}

template <int dim>
const FluidGeometry<dim>& MacFluid<dim>::freeze(const Surface& surface,
                                                const OpenFractionRule<dim>& rule) {
  MacGeometry<dim>& geometry = flow_.geometry;
  const bool is_unchanged = !geometry.pressure_block.is_null() && !geometry.state.surface &&
                            !liquid_ && (!surface || surface->empty());
  if (is_unchanged)
    return geometry;
  tiles_.make_room(surface);
  viscosity_.forget();
  flow_.forget_speed();
  FreeSurface<dim> free_surface;
  if (liquid_) {
    flow_.liquid->begin(surface);
    free_surface = flow_.liquid->surface();
  }
  geometry = make_geometry(flow_.domain, flow_.parameters.density, surface, rule,
                           liquid_ ? &free_surface : nullptr);
  if (gas_)
    gas_->settle();
  geometry.pressure_block = as_operator(pressure_operator(flow_.domain, geometry, flow_.blocks));
  geometry.regions = find_regions(flow_.domain, geometry);
  geometry.volume = static_cast<double>(geometry.pressure_map->getGlobalNumElements()) *
                    flow_.domain.cell_volume();
  check_input(!liquid_ || has_begun_ || geometry.volume > 0 || flow_.liquid->starts_empty(),
              "Of what is in \"Liquid\", nothing is in the domain and outside of solids.");
  has_begun_ = true;
  balance_waves(0, flow_);
  viscosity_.renew();
  flow_.set_prescribed(flow_.time, flow_.velocity);
  flow_.set_prescribed(flow_.time, flow_.prediction);
  return geometry;
}

template <int dim>
void MacFluid<dim>::divergence(Vector& rhs) const {
  outflow_deficit<dim>(flow_.domain, flow_.geometry, flow_.prediction, rhs);
}

template <int dim>
void MacFluid<dim>::project(const Vector& scaled_pressure) {
  if (gas_)
    gas_->project(scaled_pressure, {});
  else
    flow_.project(pressure_field(flow_.domain, flow_.geometry, scaled_pressure));
}

template <int dim>
void MacFluid<dim>::correct_pressure(const Vector& inflow) {
  // Beside air p = 0 leaves nothing to correct: it would feed on itself where nu dt > h^2 / 5.
  if (liquid_)
    return;
  const CellField field = pressure_field(flow_.domain, flow_.geometry, inflow);
  const double per_volume = 1 / flow_.domain.cell_volume();
  for (std::size_t cell = 0; cell < field.size(); ++cell)
    flow_.scaled_pressure[cell] += per_volume * field[cell];
}

template <int dim>
RCP<Vector> MacFluid<dim>::last_scaled_pressure() const {
  const RCP<Vector> result = make_vector(flow_.geometry.pressure_map);
  if (flow_.accepted_step == 0)
    return result;  // no step yet; ranks without cells have no pressures ever
  const Point<dim> at_rest =
      flow_.parameters.density * flow_.accepted_step * flow_.accepted_acceleration;
  CellField pressure =
      extended_pressure<dim>(flow_.domain, flow_.geometry.state.cells, flow_.accepted_cells,
                             flow_.accepted_pressure, at_rest, flow_.geometry.lightness);
  // Viscosity would hand on what light faces get for a moment, and they give it back a
  // thousandfold.
  if (liquid_ && !flow_.liquid->has_gas() && viscosity_.acts())
    liquid_->bound_pressure(pressure);
  // Fluid that fills its domain and rests takes up what gravity has changed by.
  const Point<dim> more = flow_.parameters.density * flow_.accepted_step *
                          (flow_.parameters.forces.uniform() - flow_.accepted_acceleration);
  const auto values = result->getDataNonConst();
  int row = 0;
  flow_.domain.grid.for_each_owned_cell([&](int cell) {
    if (flow_.geometry.state.cells[cell] == CellState::fluid)
      values[row++] = pressure[cell] + (liquid_ ? 0 : more.dot(flow_.domain.grid.center(cell)));
  });
  return result;
}

template <int dim>
std::vector<double> MacFluid<dim>::coupled_velocity() const {
  std::vector<double> result;
  result.reserve(flow_.geometry.coupled_volumes.size());
  for (const auto& [axis, cell] : flow_.geometry.coupled)
    result.push_back(flow_.prediction[axis][cell]);
  result.resize(flow_.geometry.coupled_volumes.size(), 0);
  return result;
}

template <int dim>
void MacFluid<dim>::set_coupled_velocity(const std::vector<double>& velocity) {
  LOCKSTEP_ASSERT(velocity.size() == flow_.geometry.coupled_volumes.size());
  for (std::size_t i = 0; i < flow_.geometry.coupled.size(); ++i) {
    const auto [axis, cell] = flow_.geometry.coupled[i];
    if (flow_.geometry.state.faces[axis][cell] == FaceState::coupled)
      flow_.prediction[axis][cell] = velocity[i];
  }
  flow_.domain.halo.fill(flow_.prediction);
}

template <int dim>
bool MacFluid<dim>::begin_step(double time, double dt, const std::function<double()>& solid_speed) {
  if (time != flow_.time) {  // a run that does not start at 0
    flow_.time = time;
    flow_.set_prescribed(flow_.time, flow_.velocity);
  }
  flow_.parameters.forces.set_time(time + dt / 2);
  return tiles_.begin_step(time, dt, solid_speed);
}

template <int dim>
bool MacFluid<dim>::begin_advection_velocity(double dt) {
  begin_prediction();
  if (flow_.advection_history)
    flow_.advection_history->add(dt / 2, flow_.prediction);
  if (!flow_.history)
    return true;
  flow_.history->extrapolate(dt, flow_.prediction);
  return !tiles_.are_new();
}

template <int dim>
bool MacFluid<dim>::jumped() const {
  const double round_off = 1e-6 * flow_.last_step, begin = flow_.time - flow_.last_step;
  for (const auto& sides : flow_.domain.boundary.sides)
    for (const BoundarySide<dim>& side : sides)
      if (side.jumps(begin - round_off, flow_.time))
        return true;
  return flow_.scalars.begin_to_push(begin - flow_.accepted_step + round_off, begin + round_off);
}

template <int dim>
void MacFluid<dim>::accept() {
  flow_.forget_speed();
  if (flow_.history) {
    // The geometry may have been frozen since.
    flow_.set_prescribed(flow_.time - flow_.last_step, flow_.velocity);
    flow_.history->accept(flow_.velocity, flow_.prediction, flow_.geometry.state, flow_.last_step,
                          jumped());
  }
  flow_.velocity = flow_.prediction;
  flow_.accepted_pressure = flow_.scaled_pressure;
  flow_.accepted_cells = flow_.geometry.state.cells;
  flow_.accepted_step = flow_.last_step;
  flow_.accepted_acceleration = flow_.parameters.forces.uniform();
  if (gas_)
    gas_->accept(flow_.last_step);
  tiles_.accept();
}

template <int dim>
Momentum<dim> MacFluid<dim>::push_sources(double time) {
  if (!flow_.scalars.sources_push(time))
    return {};
  const Momentum<dim> before = audit_.momentum();
  flow_.scalars.push(flow_.geometry, time, flow_.prediction);
  return audit_.momentum() - before;
}

/// Implicit, and before all forces: they must not be damped where fluid rests.
template <int dim>
Momentum<dim> MacFluid<dim>::damp(double time, double dt) {
  const FieldFormula<dim>& damping = flow_.parameters.forces.damping;
  Momentum<dim> mine;
  for (int axis = 0; axis < dim && !damping.vanishes(); ++axis) {
    CellField& velocity = flow_.prediction[axis];
    FaceMoments<dim> moments(flow_.domain.grid, axis);
    flow_.domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (flow_.geometry.state.faces[axis][cell] != FaceState::free)
        return;
      const Point<dim> x = flow_.domain.grid.face_center(axis, cell);
      const double rate = damping(0, x, time);
      check_input(rate >= 0,
                  "In \"Fluid\", \"Damping\" is {:g} 1/s at x = {} m, but must not be negative.",
                  rate, fmt::join(x.begin(), x.end(), ", "));
      const double change = -velocity[cell] * dt * rate / (1 + dt * rate);
      velocity[cell] += change;
      moments.add(cell, flow_.geometry.mass(axis, cell) * change);
    });
    mine += moments.total();
  }
  return mine;
}

template <int dim>
Momentum<dim> MacFluid<dim>::push_faces(const ForceField<dim>& force, double dt) {
  const MacGeometry<dim>& geometry = flow_.geometry;
  Momentum<dim> mine;
  for (int axis = 0; axis < dim; ++axis) {
    if (force.vanishes(axis))
      continue;
    CellField& velocity = flow_.prediction[axis];
    FaceMoments<dim> moments(flow_.domain.grid, axis);
    const auto push_one = [&](int cell) {
      const FaceState state = geometry.state.faces[axis][cell];
      if (state != FaceState::free && state != FaceState::coupled)
        return;
      const double change = dt * force(axis, cell);
      velocity[cell] += change;
      moments.add(cell, geometry.mass(axis, cell) * change);
    };
    flow_.domain.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && force.is_uniform() && geometry.has_regular_faces(axis, first)) {
        const auto change = StripValues<dim>::Constant(dt * force(axis, first));
        row_of<dim>(velocity.data(), first) += change;
        moments.add_row(first, geometry.face_table.regular().mass * change);
        return;
      }
      for (int cell = first; cell < first + n; ++cell)
        push_one(cell);
    });
    mine += moments.total();
  }
  return mine;
}

/// At the faces' centres, but the momentum counts where the fluid is.
template <int dim>
void MacFluid<dim>::push_surface(double dt) {
  const auto now = [&](int axis, int cell) { return flow_.prediction[axis][cell]; };
  const AngularVector<dim> shifts_before = moment_of_shifts<dim>(flow_.geometry, now);
  liquid_->push_surface(dt);
  const Momentum<dim> shifts{Point<dim>::Zero(),
                             moment_of_shifts<dim>(flow_.geometry, now) - shifts_before};
  flow_.surface_impulse += sum_over_ranks(shifts, flow_.domain.grid.comm());
  viscosity_.renew_tension(dt);
}

template <int dim>
ForceImpulse<dim> MacFluid<dim>::add_forces(double time, double dt) {
  flow_.time = time + dt;
  flow_.last_step = dt;
  balance_waves(dt, flow_);
  flow_.set_prescribed(flow_.time, flow_.prediction);
  ForceImpulse<dim> given;
  const MacGeometry<dim>& geometry = flow_.geometry;
  const ForceField<dim> force(flow_.domain, geometry, flow_.parameters.forces, flow_.scalars);
  Momentum<dim> mine = damp(time + dt / 2, dt);
  mine += push_of_pressures<dim>(flow_.domain, geometry, time + dt / 2, dt, flow_.velocity,
                                 flow_.prediction);
  mine += push_faces(force, dt);
  if (tiles_.move())
    mine += tiles_.push_at_band_edge(force.of_surroundings(), dt);
  if (flow_.has_drops())
    mine += speed_up_drops(flow_);
  mine.angular +=
      moment_of_shifts<dim>(geometry, [&](int axis, int cell) { return dt * force(axis, cell); });
  if (liquid_ && flow_.liquid->tension() > 0) {
    push_surface(dt);
    given.impulse += flow_.surface_impulse;
  }
  // After all forces: a step's fall on top of a source's velocity would bring more, the longer it
  // is.
  given.impulse += push_sources(time);
  flow_.domain.halo.fill(flow_.prediction);
  given.impulse += sum_over_ranks(mine, flow_.domain.grid.comm());
  given.coupled_change.reserve(geometry.coupled_volumes.size());
  for (const auto& [axis, cell] : geometry.coupled)
    given.coupled_change.push_back(dt * force(axis, cell));
  given.coupled_change.resize(geometry.coupled_volumes.size(), 0);
  return given;
}

template <int dim>
TransportSetting<dim> MacFluid<dim>::transport_setting(double time, double dt,
                                                       const MovingSurface<dim>& surface,
                                                       const FaceField<dim>& advection) {
  const MacParameters<dim>& parameters = flow_.parameters;
  TransportSetting<dim> setting{flow_.domain.grid,
                                flow_.geometry.state,
                                surface,
                                advection,
                                flow_.ray_halo,
                                flow_.nearby,
                                {},
                                dt,
                                parameters.phases.liquid.viscosity / parameters.density,
                                parameters.advection == AdvectionScheme::cubic ? 2 : 1};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = flow_.domain.boundary.side(axis, end);
      TransportSide<dim>& seen = setting.sides[axis][end];
      seen.inflow = side.type == SideType::inflow;
      seen.closed = side.closed();
      seen.velocity = [&side, axis, time](const Point<dim>& x) {
        return side.velocity_at(axis, x, time);
      };
    }
  return setting;
}

template <int dim>
void MacFluid<dim>::advect_scalars(double time, Transport<dim>& transport) {
  for (Scalar& scalar : flow_.scalars.all()) {
    SideValues<dim> inflow;
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const BoundarySide<dim>& side = flow_.domain.boundary.side(axis, end);
        const FieldFormula<dim>& carried = scalar.name == "smoke" ? side.smoke : side.temperature;
        inflow[axis][end] = [&carried, time](const Point<dim>& x) { return carried(0, x, time); };
      }
    CellField carried(scalar.values.size(), 0.0);
    transport.advect_scalar(flow_.parameters.advection, scalar.values, inflow, carried, nullptr,
                            scalar.ambient);
    scalar.values.swap(carried);
  }
}

template <int dim>
void MacFluid<dim>::advect(double time, double dt, const MovingSurface<dim>& surface) {
  // Without solids nothing has changed: one field to store, and to extend. All ranks must agree.
  // A source changes the velocity of the liquid's surface (MacLiquid::move), not the fluid's own.
  const bool differs =
      flow_.prediction != flow_.velocity || (liquid_ && flow_.scalars.sources_push(time));
  const bool has_own =
      liquid_ ? max_all(flow_.domain.grid.comm(), GlobalIndex(differs)) > 0 : differs;
  FaceField<dim> own = has_own ? flow_.prediction : FaceField<dim>();
  FaceField<dim>& advection = has_own ? own : flow_.velocity;
  std::unique_ptr<InterfaceTransport<dim>> near_interface;  // at t^n
  if (flow_.parameters.phases.gas && flow_.parameters.phases.transport_is_consistent)
    near_interface = std::make_unique<InterfaceTransport<dim>>(
        flow_.domain, flow_.geometry, flow_.liquid->interface().distance(), advection, dt);
  if (liquid_)
    liquid_->move(time, dt, surface, advection);
  const TransportSetting<dim> setting = transport_setting(time, dt, surface, advection);
  Transport<dim> transport(setting);
  const AdvectionScheme scheme = flow_.parameters.advection;
  if (flow_.history) {
    FaceField<dim> start = flow_.velocity;
    flow_.history->add_acceleration(dt / 2, start);
    transport.advect_faces(scheme, start, flow_.prediction);
    flow_.history->add_acceleration(-dt / 2, flow_.prediction);
  } else if (flow_.advection_history) {
    FaceField<dim> start = flow_.velocity;
    flow_.advection_history->add(-dt / 2, start);
    transport.advect_faces(scheme, start, flow_.prediction);
    flow_.advection_history->begin(std::move(start), flow_.geometry.state, dt);
  } else {
    transport.advect_faces(scheme, flow_.velocity, flow_.prediction);
  }
  if (near_interface)
    carried_ = near_interface->advect(flow_.velocity, flow_.prediction);
  flow_.domain.halo.fill(flow_.prediction);
  advect_scalars(time, transport);
  invalid_ = transport.invalid();
  flow_.scalars.feed(flow_.geometry, time);
  for (Scalar& scalar : flow_.scalars.all())
    flow_.domain.halo.fill(scalar.values);
}

template <int dim>
void MacFluid<dim>::populate_uncovered(const MovingSurface<dim>& surface) {
  const GridState<dim>& state = flow_.geometry.state;
  if (state.surface || flow_.parameters.phases.gas) {
    const MacDomain<dim>& domain = flow_.domain;
    std::function<double(int, int)> density;  // light gas says little of the liquid beside it
    if (flow_.parameters.phases.gas)
      density = [this](int axis, int face) {
        return flow_.geometry.face_table(axis, face).density;
      };
    correct_flooded<dim>(flow_.geometry, std::exchange(carried_, {}), flow_.prediction, invalid_);
    const UncoveredGrid<dim> uncovered{domain.grid,  domain.halo, state,  surface,
                                       flow_.nearby, invalid_,    density};
    populate_uncovered_faces<dim>(uncovered, flow_.prediction);
    for (Scalar& scalar : flow_.scalars.all())
      populate_uncovered_scalar(uncovered, scalar.ambient, scalar.values);
    invalid_ = {};
  }
  if (flow_.has_drops())
    give_back_momentum(flow_);
  if (flow_.history)
    flow_.history->set_advected(flow_.prediction);
  if (flow_.advection_history)
    flow_.advection_history->end(flow_.prediction, flow_.geometry.state);
}

template <int dim>
std::array<std::array<bool, 2>, dim> MacFluid<dim>::closed_sides() const {
  std::array<std::array<bool, 2>, dim> closed{};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      closed[axis][end] = flow_.domain.boundary.side(axis, end).closed();
  return closed;
}

template <int dim>
Point<dim> MacFluid<dim>::wall_velocity(int axis, int end, double time) const {
  const BoundarySide<dim>& side = flow_.domain.boundary.side(axis, end);
  return side.closed() ? side.velocity_at(axis, bounds().center(), time) : Point<dim>::Zero();
}

template <int dim>
std::array<bool, dim> MacFluid<dim>::periodic_axes() const {
  return flow_.domain.grid.description().periodic;
}

template <int dim>
std::vector<PrescribedFlux> MacFluid<dim>::side_fluxes(double time) const {
  return fluxes_of_sides(flow_.domain, flow_.geometry, time);
}

template <int dim>
void MacFluid<dim>::save(CheckpointWriter& checkpoint) const {
  flow_.save(checkpoint);
  tiles_.save(checkpoint);
}

template <int dim>
void MacFluid<dim>::load(const CheckpointReader& checkpoint) {
  tiles_.load(checkpoint);
  flow_.load(checkpoint);
}

template <int dim>
void MacFluid<dim>::set_prediction(const std::function<Point<dim>(const Point<dim>&)>& velocity) {
  for (int axis = 0; axis < dim; ++axis)
    flow_.domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (flow_.geometry.state.faces[axis][cell] == FaceState::free)
        flow_.prediction[axis][cell] = velocity(flow_.domain.grid.face_center(axis, cell))[axis];
    });
  flow_.domain.halo.fill(flow_.prediction);
}

template class MacFluid<2>;
template class MacFluid<3>;

}  // namespace lockstep
