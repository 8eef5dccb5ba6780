#include "mac/mac_fluid.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "mac/make_geometry.hpp"
#include "mac/pressure/extended_pressure.hpp"
#include "mac/state/face_moments.hpp"
#include "mac/state/initial_state.hpp"

namespace lockstep {

template <int dim>
MacFluid<dim>::MacFluid(const ParameterList& fluid, const ParameterList& domain,
                        const Communicator& comm, const InterfaceRegistry<dim>* interfaces)
    : domain_(make_domain<dim>(fluid, domain, comm)),
      parameters_(read_mac_parameters<dim>(fluid)),
      scalars_(domain_, fluid),
      ray_halo_(domain_.grid),
      lattice_blocks_(lattice_blocks(domain_.grid)),
      velocity_(initial_velocity<dim>(domain_.grid, fluid.sublist("Initial State"))) {
  domain_.halo.fill(velocity_);
  prediction_ = velocity_;
  scaled_pressure_.assign(domain_.grid.n_stored_cells(), 0.0);
  accepted_pressure_ = scaled_pressure_;
  fields_ = {stored_faces<dim>("velocity", velocity_)};
  if (parameters_.order_in_time == 2) {
    history_.emplace(domain_.grid);
    for (StoredField& field : history_->fields())
      fields_.push_back(std::move(field));
  }
  for (Scalar& scalar : scalars_.all())
    fields_.push_back({scalar.name, {&scalar.values}, scalar.ambient});
  fields_.push_back({"scaled_pressure", {&accepted_pressure_}});
  if (fluid.isSublist("Free Surface"))
    liquid_ = std::make_unique<Liquid<dim>>(fluid, parameters_.forces, *interfaces, domain_);
  if (liquid_)
    for (StoredField& field : liquid_->fields())
      fields_.push_back(std::move(field));
  if (fluid.isSublist("Moving Tiles")) {
    check_input(!liquid_ || migrating_interface(),
                "The interface \"{}\" cannot follow \"Moving Tiles\"; leave them out.",
                liquid_ ? liquid_->interface().name() : "");
    moving_tiles_.emplace(fluid,
                          DomainDescription<dim>{domain_.grid.description(), domain_.boundary});
    owners_ = domain_.grid.tile_owners();
  }
}

template <int dim>
const FluidGeometry<dim>& MacFluid<dim>::freeze(const Surface& surface,
                                                const OpenFractionRule<dim>& rule) {
  const bool is_first = geometry_.pressure_block.is_null();
  const bool unchanged =
      !is_first && !geometry_.state.surface && !liquid_ && (!surface || surface->empty());
  if (unchanged)
    return geometry_;
  if (moving_tiles_ && !has_room_)
    make_room_for(surface);
  if (moving_tiles_ && surface)
    moving_tiles_->check_room(*surface, owners_, domain_.grid.comm());
  viscosity_.reset();
  largest_speed_.reset();
  FreeSurface<dim> free_surface;
  if (liquid_) {
    liquid_->begin(surface);
    free_surface = liquid_->surface();
  }
  geometry_ =
      make_geometry(domain_, parameters_.density, surface, rule, liquid_ ? &free_surface : nullptr);
  if (holds_gas())
    settle_gas();
  geometry_.pressure_block = as_operator(pressure_operator(domain_, geometry_, lattice_blocks_));
  geometry_.regions = find_regions(domain_, geometry_);
  geometry_.volume =
      static_cast<double>(geometry_.pressure_map->getGlobalNumElements()) * domain_.cell_volume();
  check_input(!liquid_ || has_begun_ || geometry_.volume > 0 || liquid_->starts_empty(),
              "Of what is in \"Liquid\", nothing is in the domain and outside of solids.");
  has_begun_ = true;
  if (parameters_.viscosity.viscosity > 0 && !tension_is_implicit())
    viscosity_ = std::make_unique<Viscosity<dim>>(domain_, geometry_, parameters_.viscosity);
  set_prescribed(time_, velocity_);
  set_prescribed(time_, prediction_);
  return geometry_;
}

template <int dim>
void MacFluid<dim>::divergence(Vector& rhs) const {
  outflow_deficit<dim>(domain_, geometry_, prediction_, rhs);
}

template <int dim>
void MacFluid<dim>::project(const Vector& scaled_pressure,
                            const std::vector<double>& gas_pressure) {
  scaled_pressure_ = pressure_field(domain_, geometry_, scaled_pressure);
  if (holds_gas())
    liquid_->gas()->fill(gas_pressure, scaled_pressure_);
  subtract_gradient<dim>(domain_, geometry_, scaled_pressure_, prediction_);
  domain_.halo.fill(prediction_);
}

template <int dim>
void MacFluid<dim>::correct_pressure(const Vector& inflow) {
  // Beside a void p = 0 leaves nothing to correct: it would feed on itself where nu dt > h^2 / 5.
  if (liquid_)
    return;
  const CellField field = pressure_field(domain_, geometry_, inflow);
  const double per_volume = 1 / domain_.cell_volume();
  for (std::size_t cell = 0; cell < field.size(); ++cell)
    scaled_pressure_[cell] += per_volume * field[cell];
}

template <int dim>
RCP<Vector> MacFluid<dim>::last_scaled_pressure() const {
  const RCP<Vector> result = make_vector(geometry_.pressure_map);
  if (accepted_step_ == 0)
    return result;  // no step yet; ranks without cells have no pressures ever
  const Point<dim> at_rest = parameters_.density * accepted_step_ * parameters_.forces.uniform();
  CellField pressure = extended_pressure<dim>(domain_, geometry_.state.cells, accepted_cells_,
                                              accepted_pressure_, at_rest);
  // Viscosity would hand on what light faces get for a moment, and they give it back a
  // thousandfold.
  if (liquid_ && is_viscous())
    bound_pressure(pressure);
  const auto values = result->getDataNonConst();
  int row = 0;
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (geometry_.state.cells[cell] == CellState::fluid)
      values[row++] = pressure[cell];
  });
  return result;
}

template <int dim>
std::vector<double> MacFluid<dim>::coupled_velocity() const {
  std::vector<double> result;
  result.reserve(geometry_.coupled_volumes.size());
  for (const auto& [axis, cell] : geometry_.coupled)
    result.push_back(prediction_[axis][cell]);
  result.resize(geometry_.coupled_volumes.size(), 0);
  return result;
}

template <int dim>
void MacFluid<dim>::set_coupled_velocity(const std::vector<double>& velocity) {
  LOCKSTEP_ASSERT(velocity.size() == geometry_.coupled_volumes.size());
  for (std::size_t i = 0; i < geometry_.coupled.size(); ++i) {
    const auto [axis, cell] = geometry_.coupled[i];
    if (geometry_.state.faces[axis][cell] == FaceState::coupled)
      prediction_[axis][cell] = velocity[i];
  }
  domain_.halo.fill(prediction_);
}

template <int dim>
void MacFluid<dim>::begin_prediction() {
  prediction_ = velocity_;
}

template <int dim>
bool MacFluid<dim>::begin_advection_velocity(double dt) {
  begin_prediction();
  if (!history_)
    return true;
  history_->extrapolate(dt, prediction_);
  // Rates of cells that were made one step ago are not those of a flow.
  return steps_since_regrid_ > 1;
}

template <int dim>
bool MacFluid<dim>::jumped() const {
  const double round_off = 1e-6 * last_step_, begin = time_ - last_step_;
  for (const auto& sides : domain_.boundary.sides)
    for (const BoundarySide<dim>& side : sides)
      if (side.jumps(begin - round_off, time_))
        return true;
  return scalars_.begin_to_push(begin - accepted_step_ + round_off, begin + round_off);
}

template <int dim>
void MacFluid<dim>::accept() {
  largest_speed_.reset();
  if (history_) {
    set_prescribed(time_ - last_step_, velocity_);  // the geometry may have been frozen since
    history_->accept(velocity_, prediction_, geometry_.state, last_step_, jumped());
  }
  steps_since_regrid_ = std::min(steps_since_regrid_ + 1, 2);
  velocity_ = prediction_;
  accepted_pressure_ = scaled_pressure_;
  accepted_cells_ = geometry_.state.cells;
  accepted_step_ = last_step_;
  if (holds_gas())
    liquid_->gas()->accept(last_step_);
  steps_to_sharing_ = std::max(steps_to_sharing_ - 1, 0);
}

template <int dim>
std::function<void()> MacFluid<dim>::undo() {
  std::vector<CellField> before;
  for (const Scalar& scalar : scalars_.all())
    before.push_back(scalar.values);
  const auto undo_liquid = liquid_ ? liquid_->undo() : [] {};
  return [this, before = std::move(before), undo_liquid, time = time_, last_step = last_step_] {
    undo_liquid();
    for (std::size_t s = 0; s < before.size(); ++s)
      scalars_.all()[s].values = before[s];
    scaled_pressure_ = accepted_pressure_;
    time_ = time;
    last_step_ = last_step;
  };
}

template <int dim>
Momentum<dim> MacFluid<dim>::push_sources(double time) {
  if (!scalars_.sources_push(time))
    return {};
  const Momentum<dim> before = momentum();
  scalars_.push(geometry_, time, prediction_);
  return momentum() - before;
}

template <int dim>
ForceImpulse<dim> MacFluid<dim>::add_forces(double time, double dt) {
  time_ = time + dt;
  last_step_ = dt;
  set_prescribed(time_, prediction_);
  ForceImpulse<dim> given;
  given.impulse = push_sources(time);
  const ForceField<dim> force(domain_, geometry_, parameters_.forces, scalars_);
  Momentum<dim> mine;
  for (int axis = 0; axis < dim; ++axis) {
    if (force.vanishes(axis))
      continue;
    FaceMoments<dim> moments(domain_.grid, axis);
    const auto push_one = [&](int cell) {
      if (!moves(axis, cell))
        return;
      const double change = dt * force(axis, cell);
      prediction_[axis][cell] += change;
      moments.add(cell, geometry_.mass(axis, cell) * change);
    };
    domain_.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && force.is_uniform() && geometry_.has_regular_faces(axis, first)) {
        const auto change = RowValues<dim>::Constant(dt * force(axis, first));
        row_of<dim>(prediction_[axis].data(), first) += change;
        moments.add_row(first, geometry_.face_table.regular().mass * change);
        return;
      }
      for (int cell = first; cell < first + n; ++cell)
        push_one(cell);
    });
    mine += moments.total();
  }
  if (moving_tiles_)
    mine += push_at_rim(force.of_surroundings(), dt);
  if (has_drops())
    mine += speed_up_drops();
  mine.angular += moment_of_shifts([&](int axis, int cell) { return dt * force(axis, cell); });
  if (liquid_ && liquid_->tension() > 0) {
    const auto now = [&](int axis, int cell) { return prediction_[axis][cell]; };
    const AngularVector<dim> shifts_before = moment_of_shifts(now);
    push_surface(dt);  // at the faces' centres, but the momentum counts where the fluid is
    const Momentum<dim> shifts{Point<dim>::Zero(), moment_of_shifts(now) - shifts_before};
    surface_impulse_ += sum_over_ranks(shifts, domain_.grid.comm());
    given.impulse += surface_impulse_;
    if (liquid_->tension_is_implicit()) {
      const ImplicitTension implicit{dt * liquid_->tension(), &liquid_->interface().distance()};
      viscosity_ =
          std::make_unique<Viscosity<dim>>(domain_, geometry_, parameters_.viscosity, implicit);
    }
  }
  domain_.halo.fill(prediction_);
  given.impulse += sum_over_ranks(mine, domain_.grid.comm());
  given.coupled_change.reserve(geometry_.coupled_volumes.size());
  for (const auto& [axis, cell] : geometry_.coupled)
    given.coupled_change.push_back(dt * force(axis, cell));
  given.coupled_change.resize(geometry_.coupled_volumes.size(), 0);
  return given;
}

template <int dim>
std::unique_ptr<ViscousSystem<dim>> MacFluid<dim>::viscous_system() const {
  return viscosity_ ? viscosity_->system(prediction_, time_) : nullptr;
}

template <int dim>
Momentum<dim> MacFluid<dim>::accept_viscous(const Vector& solution, const Vector& velocity,
                                            double dt) {
  const auto now = [&](int axis, int cell) { return prediction_[axis][cell]; };
  Momentum<dim> shifts;
  shifts.angular = -moment_of_shifts(now);
  viscosity_->store(solution, prediction_);
  domain_.halo.fill(prediction_);
  Momentum<dim> impulse = viscosity_->impulse(prediction_, time_, dt);
  if (tension_is_implicit()) {
    const Momentum<dim> implicit = viscosity_->tension_impulse(prediction_, dt);
    surface_impulse_ += implicit;
    impulse += implicit;
  }
  viscosity_->store(velocity, prediction_);
  domain_.halo.fill(prediction_);
  // The scheme's forces act at the faces' centres, the momentum counts where the fluid is.
  shifts.angular += moment_of_shifts(now);
  return impulse + sum_over_ranks(shifts, domain_.grid.comm());
}

template <int dim>
void MacFluid<dim>::advect(double time, double dt, const MovingSurface<dim>& surface) {
  // Without solids nothing has changed: one field to store, and to extend. All ranks must agree.
  const bool differs = prediction_ != velocity_;
  const bool has_own = liquid_ ? max_all(domain_.grid.comm(), GlobalIndex(differs)) > 0 : differs;
  FaceField<dim> own = has_own ? prediction_ : FaceField<dim>();
  FaceField<dim>& advection = has_own ? own : velocity_;
  if (liquid_)
    move_liquid(time, dt, surface, advection);
  TransportSetting<dim> setting{domain_.grid,
                                geometry_.state,
                                surface,
                                advection,
                                ray_halo_,
                                nearby_,
                                {},
                                dt,
                                parameters_.viscosity.viscosity / parameters_.density,
                                parameters_.advection == AdvectionScheme::cubic ? 2 : 1};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = domain_.boundary.side(axis, end);
      TransportSide<dim>& seen = setting.sides[axis][end];
      seen.inflow = side.type == SideType::inflow;
      seen.closed = side.closed();
      seen.velocity = [&side, axis, time](const Point<dim>& x) {
        return side.velocity_at(axis, x, time);
      };
    }
  Transport<dim> transport(setting);
  if (history_) {
    FaceField<dim> start = velocity_;
    history_->add_acceleration(dt / 2, start);
    transport.advect_faces(parameters_.advection, start, prediction_);
    history_->add_acceleration(-dt / 2, prediction_);
  } else {
    transport.advect_faces(parameters_.advection, velocity_, prediction_);
  }
  domain_.halo.fill(prediction_);
  for (Scalar& scalar : scalars_.all()) {
    SideValues<dim> inflow;
    std::copy(scalar.inflow.begin(), scalar.inflow.end(), inflow.begin());
    CellField carried(scalar.values.size(), 0.0);
    transport.advect_scalar(parameters_.advection, scalar.values, inflow, carried, nullptr,
                            scalar.ambient);
    scalar.values.swap(carried);
  }
  invalid_ = transport.invalid();
  scalars_.feed(geometry_, time);
  for (Scalar& scalar : scalars_.all())
    domain_.halo.fill(scalar.values);
}

template <int dim>
void MacFluid<dim>::revalidate(const MovingSurface<dim>& surface) {
  if (geometry_.state.surface) {
    revalidate_faces<dim>(domain_.grid, domain_.halo, geometry_.state, surface, nearby_, invalid_,
                          prediction_);
    for (Scalar& scalar : scalars_.all())
      revalidate_scalar(domain_.grid, domain_.halo, geometry_.state, surface, nearby_, invalid_,
                        scalar.ambient, scalar.values);
    invalid_ = {};
  }
  if (has_drops())
    give_back_momentum();
  if (history_)
    history_->set_advected(prediction_);
}

template <int dim>
Momentum<dim> MacFluid<dim>::boundary_pressure_impulse(const Vector& scaled_pressure) const {
  return side_pressure_impulse(domain_, geometry_, scaled_pressure);
}

template <int dim>
void MacFluid<dim>::set_prediction(const std::function<Point<dim>(const Point<dim>&)>& velocity) {
  for (int axis = 0; axis < dim; ++axis)
    domain_.grid.for_each_owned_face(axis, [&](int cell) {
      if (geometry_.state.faces[axis][cell] == FaceState::free)
        prediction_[axis][cell] = velocity(domain_.grid.face_center(axis, cell))[axis];
    });
  domain_.halo.fill(prediction_);
}

template class MacFluid<2>;
template class MacFluid<3>;

}  // namespace lockstep
