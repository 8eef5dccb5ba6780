#include "liquid/liquid.hpp"

#include <cmath>
#include <numeric>

#include "base/errors.hpp"
#include "liquid/common/dry_cells.hpp"
#include "liquid/surface/surface_tension.hpp"
#include "liquid/surface/wave_damping.hpp"

namespace lockstep {

namespace {
template <int dim>
std::array<bool, dim> periodic_axes(const MacDomain<dim>& domain) {
  std::array<bool, dim> periodic;
  for (int axis = 0; axis < dim; ++axis)
    periodic[axis] = domain.boundary.periodic(axis);
  return periodic;
}

/// Along an axis, over all ranks [cells].
template <int dim>
double largest_displacement(const MacDomain<dim>& domain, const GridState<dim>& state,
                            const FaceField<dim>& velocity, double dt) {
  double fastest = 0;
  for (int axis = 0; axis < dim; ++axis)
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (is_wet(state.faces[axis][cell]))
        fastest = std::max(fastest, std::abs(velocity[axis][cell]));
    });
  return max_all(domain.grid.comm(), fastest) * dt / domain.spacing();
}

constexpr const char* smallest_cavity = "Smallest Cavity";

/// Rounds a ratio of densities to 20 binary digits, so that the coefficients of a cell of gas add
/// up without rounding in single precision (FaceCoefficients). Changes the density by at most 5e-7.
double rounded_for_sums(double ratio) {
  constexpr int digits = 20;
  int exponent = 0;
  std::frexp(ratio, &exponent);
  return std::ldexp(std::round(std::ldexp(ratio, digits - exponent)), exponent - digits);
}

/// Beyond what is extended nothing moves: what the liquid once left there would count as motion.
template <int dim>
void stop_beyond(const GridState<dim>& state, FaceField<dim>& velocity) {
  for (int axis = 0; axis < dim; ++axis)
    for (std::size_t cell = 0; cell < velocity[axis].size(); ++cell)
      if (state.faces[axis][cell] == FaceState::inactive)
        velocity[axis][cell] = 0;
}
}  // namespace

template <int dim>
Liquid<dim>::Liquid(const ParameterList& fluid, const Point<dim>& gravity,
                    const Point<dim>& acceleration, const InterfaceRegistry<dim>& interfaces,
                    const MacDomain<dim>& domain)
    : domain_(domain), filter_shift_(domain.grid.n_stored_cells(), 0.0) {
  check_free_surface<dim>(fluid, gravity, periodic_axes(domain));
  const ParameterList& list = fluid.sublist("Free Surface");
  parameters_ = read_free_surface(list);
  const Phases phases = read_phases(fluid);
  const double density = phases.liquid.density;
  if (phases.gas)
    gas_density_ = density / rounded_for_sums(density / phases.gas->density);
  // omega^2 = k ((rho_1 - rho_2) g + sigma k^2) / (rho_1 + rho_2)
  short_wave_acceleration_ = (std::abs(density - gas_density_) * acceleration.norm() +
                              parameters_.tension / std::pow(domain.spacing(), 2)) /
                             (density + gas_density_);
  initial_distance_ = read_liquid<dim>(fluid, gravity);
  starts_empty_ = list.sublist("Liquid").numParams() == 0;
  sinks_ = read_sinks<dim>(list);
  dry_points_ = read_dry_points<dim>(list);
  auto watches = read_watches<dim>(list);
  if (!watches.empty())
    watched_ = std::make_unique<WatchedPlaces<dim>>(domain, std::move(watches));
  if (const auto gas = read_gas<dim>(fluid); gas.kind != TrappedAir::none)
    gas_ = std::make_unique<GasBubbles<dim>>(domain, gas, gravity);
  ParameterList interface = list.sublist("Interface");
  if (has_gas() && interface.isParameter(smallest_cavity))
    interface.set(smallest_cavity, 0);  // a bubble has mass and pressure, and drains nothing
  interface_ = interfaces.create(interface.get<std::string>("Type"), interface, domain);
}

template <int dim>
void Liquid<dim>::begin(const Surface& surface) {
  lattice_.emplace(domain_.grid);
  if (!initial_distance_)
    return interface_->meet_solids(surface);
  if (!dry_points_.empty()) {
    const NearbySurface<dim> nearby(surface && !surface->empty() ? surface : nullptr, domain_.grid,
                                    2);
    const auto dry = find_dry_cells<dim>(domain_, initial_distance_, nearby, dry_points_);
    initial_distance_ = [this, dry, filled = initial_distance_](const Point<dim>& x) {
      const int cell = domain_.grid.cell_containing(x);
      const double distance = filled(x);
      return cell >= 0 && dry[cell] ? std::max(std::abs(distance), domain_.spacing()) : distance;
    };
  }
  if (watched_)
    watched_->begin(surface);
  interface_->initialise(initial_distance_, surface);
  initial_distance_ = nullptr;
}

template <int dim>
FreeSurface<dim> Liquid<dim>::surface() {
  FreeSurface<dim> surface;
  surface.distance = &interface_->distance();
  if (parameters_.tension > 0) {
    leading_distance_ = interface_->distance();
    for (std::size_t cell = 0; cell < leading_distance_.size(); ++cell)
      leading_distance_[cell] += filter_shift_[cell];
    surface.curvature = [this](int wet, int axis, int side, double place) {
      // Below air without mass, drops that swing would gain by what heights see of short waves.
      const auto known =
          has_gas() ? interface_->curvature(wet, axis, side, place, filter_shift_) : std::nullopt;
      return known ? *known : curvature(domain_, leading_distance_, wet, axis, side, place);
    };
  }
  // All crossings about a wet cell's centre must be at one place, or the capillary force would
  // drive the fluid between two such places, by its difference over next to no distance.
  surface.crossing = [this, &phi = interface_->distance()](int wet, int dry) {
    const double part = interface_->crossing(wet, dry);
    const double lead = (1 - part) * filter_shift_[wet] + part * filter_shift_[dry];
    return lead == 0 ? part
                     : std::clamp(part - lead / (phi[dry] - phi[wet]),
                                  FreeSurface<dim>::smallest_distance, 1.0);
  };
  surface.at_true_place = parameters_.pressure_order == 2;
  surface.gas = gas_.get();
  surface.gas_density = gas_density_;
  return surface;
}

template <int dim>
void Liquid<dim>::extend(const InterfaceStep<dim>& step, const std::vector<char>& near,
                         GridState<dim>& state, FaceField<dim>& advection_velocity,
                         FaceField<dim>& velocity) const {
  const double displacement =
      largest_displacement<dim>(domain_, state, advection_velocity, step.dt);
  // Beyond the domain nothing is left to extend to, however fast a run is that has become unstable.
  const auto& n_cells = domain_.grid.n_cells();
  const double farthest = std::accumulate(n_cells.begin(), n_cells.end(), 1.0);
  const double band = interface_->band(std::min(displacement, farthest)) * domain_.spacing();
  const auto solids = step.kept.of(state.surface, domain_.grid, 2);
  const double known = interface_->band(0) * domain_.spacing();
  const VelocityExtension<dim> extension(domain_, {interface_->distance(), known, band}, near,
                                         *solids, state);
  extension.extend(step.time, step.surface.velocity, advection_velocity);
  stop_beyond<dim>(state, advection_velocity);
  if (&velocity != &advection_velocity) {
    extension.extend(step.time, step.surface.velocity, velocity);
    stop_beyond<dim>(state, velocity);
  }
}

namespace {
/// The state of the samples if the gas had no mass.
template <int dim>
GridState<dim> without_gas(const MacDomain<dim>& domain, const CellField& distance,
                           GridState<dim> state) {
  domain.grid.for_each_stored_cell([&](int cell) {
    if (state.cells[cell] == CellState::fluid && distance[cell] >= 0)
      state.cells[cell] = CellState::air;
  });
  const auto is_fluid = [&](int cell) {
    return cell >= 0 && state.cells[cell] == CellState::fluid;
  };
  for (int axis = 0; axis < dim; ++axis)
    for (int face = 0; face < domain.grid.n_stored_cells(); ++face) {
      const FaceCells cells = cells_of_face(domain.grid, state.cells, axis, face);
      if (!is_fluid(cells.lower) && !is_fluid(cells.upper))
        state.faces[axis][face] = FaceState::inactive;
    }
  return state;
}

template <int dim>
InterfaceStep<dim> with_velocity(const FaceField<dim>& velocity, const InterfaceStep<dim>& step) {
  return {velocity, step.surface, step.ray_halo, step.kept,    step.time,
          step.dt,  step.sources, step.sinks,    step.gravity, step.open};
}
}  // namespace

/// A gas slips along a surface, so that velocities between the two are those of neither: waves
/// would grow by a sixth in a period. Below a gas, too, the surface moves with the liquid, unless
/// it is moved by what flows through faces.
template <int dim>
void Liquid<dim>::advance(const InterfaceStep<dim>& step, MacGeometry<dim>& geometry,
                          FaceField<dim>& advection_velocity, FaceField<dim>& velocity) {
  FaceField<dim> of_liquid;
  const bool has_own = has_gas() && !interface_->moves_by_fluxes();
  if (has_own) {
    of_liquid = advection_velocity;
    GridState<dim> state = without_gas(domain_, interface_->distance(), geometry.state);
    extend(step, geometry.near, state, of_liquid, of_liquid);
  } else if (!has_gas()) {
    extend(step, geometry.near, geometry.state, advection_velocity, velocity);
  }
  const FaceField<dim>& of_surface = has_own ? of_liquid : advection_velocity;
  if (short_wave_acceleration_ > 0)
    filter_shift_ = short_wave_filter<dim>(domain_, geometry, interface_->distance(), of_surface,
                                           short_wave_acceleration_, step.dt);
  if (gas_)
    gas_->pass_over(step.surface);
  const InterfaceStep<dim> of_interface = with_velocity<dim>(of_surface, step);
  interface_->advance(of_interface);
  if (watched_)
    watched_->measure(of_interface, *interface_);
}

template <int dim>
double Liquid<dim>::distance(const Point<dim>& x) const {
  const Point<dim> place = (domain_.grid.wrap(x) - domain_.grid.lower()) / domain_.spacing();
  const auto stencil = lattice_->locate(cell_centers, place);
  return interpolate<dim>(stencil, interface_->distance().data());
}

template <int dim>
LiquidReport Liquid<dim>::report() const {
  const LiquidLedger ledger = interface_->ledger();
  LiquidReport report;
  report.volume = ledger.volume;
  report.target = ledger.target;
  report.shift = ledger.shift;
  report.lost = ledger.lost;
  report.n_bodies = ledger.n_components;
  if (watched_)
    report.watches = watched_->report();
  if (gas_)
    report.gas = gas_->report();
  if (drops())
    report.drops = drops()->report();
  return report;
}

template <int dim>
std::vector<std::string> Liquid<dim>::watch_names() const {
  std::vector<std::string> names;
  if (watched_)
    for (const Watch<dim>& watch : watched_->watches())
      names.push_back(watch.name);
  return names;
}

template <int dim>
std::vector<StoredField> Liquid<dim>::fields() {
  std::vector<StoredField> fields = {{"surface_filter_shift", {&filter_shift_}}};
  const auto add = [&](std::vector<StoredField> more) {
    fields.insert(fields.end(), more.begin(), more.end());
  };
  if (gas_)
    add(gas_->fields());
  if (watched_)
    add(watched_->fields());
  return fields;
}

template class Liquid<2>;
template class Liquid<3>;

}  // namespace lockstep
