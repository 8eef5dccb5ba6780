#include "mac/state/mac_flow.hpp"

#include <algorithm>
#include <cmath>

#include "mac/pressure/pressure_system.hpp"
#include "mac/state/initial_state.hpp"
#include "mac/tiles/moving_tiles.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

template <int dim>
MacFlow<dim>::MacFlow(const ParameterList& fluid, const ParameterList& box,
                      const Communicator& comm, const InterfaceRegistry<dim>* interfaces)
    : domain(make_domain<dim>(fluid, box, comm)),
      parameters(read_mac_parameters<dim>(fluid)),
      scalars(domain, fluid),
      ray_halo(domain.grid),
      blocks(lattice_blocks(domain.grid)),
      velocity(initial_velocity<dim>(domain.grid, FieldFormula<dim>(fluid, "Velocity", "Fluid"))) {
  domain.halo.fill(velocity);
  prediction = velocity;
  scaled_pressure.assign(domain.grid.n_stored_cells(), 0.0);
  accepted_pressure = scaled_pressure;
  fields = {stored_faces<dim>("velocity", velocity)};
  if (parameters.order_in_time == 2) {
    history.emplace(domain.grid);
    for (StoredField& field : rates())
      fields.push_back(std::move(field));
  }
  for (Scalar& scalar : scalars.all())
    fields.push_back({scalar.name, {&scalar.values}, scalar.ambient});
  fields.push_back({"scaled_pressure", {&accepted_pressure}});
  if (fluid.isSublist("Free Surface"))
    liquid = std::make_unique<Liquid<dim>>(fluid, parameters.forces.gravity,
                                           parameters.forces.uniform(), *interfaces, domain);
  if (liquid)
    for (StoredField& field : liquid->fields())
      fields.push_back(std::move(field));
}

template <int dim>
void MacFlow<dim>::project(CellField pressure) {
  scaled_pressure = std::move(pressure);
  subtract_gradient<dim>(domain, geometry, scaled_pressure, prediction);
  domain.halo.fill(prediction);
}

template <int dim>
void MacFlow<dim>::set_prescribed(double at_time, FaceField<dim>& of) const {
  for (const auto& [axis, cell] : geometry.prescribed) {
    const int end = geometry.state.cells[cell] == CellState::outside ? 1 : 0;
    const Box<dim> face = domain.face_box(axis, cell);
    of[axis][cell] = domain.boundary.side(axis, end).mean_velocity(axis, face, at_time)[axis];
  }
  domain.halo.fill(of);
}

template <int dim>
double MacFlow<dim>::largest_speed() const {
  if (largest_speed_)
    return *largest_speed_;
  double largest = 0;
  const auto speed = [&](int axis, int face) {
    const bool still = face < 0 || geometry.state.faces[axis][face] == FaceState::inactive;
    return still ? 0.0 : std::abs(velocity[axis][face]);
  };
  const auto look_at_cell = [&](int cell, const auto& neighbors) {
    if (geometry.state.cells[cell] != CellState::fluid)
      return;
    double sum = 0;
    for (int axis = 0; axis < dim; ++axis)
      sum += std::max(speed(axis, cell), speed(axis, neighbors[2 * axis + 1]));
    largest = std::max(largest, sum);
  };
  StripValues<dim> largest_in_rows = StripValues<dim>::Zero();
  domain.grid.for_each_owned_strip([&](const CellStrip<dim>& row) {
    if (!geometry.has_regular_faces(row)) {
      row.for_each_cell(look_at_cell);
      return;
    }
    const StripValues<dim> along = row_of<dim>(velocity[0].data(), row.begin).abs();
    StripValues<dim> sum = along.max(row_ahead<dim>(along, speed(0, row.neighbors[1])));
    for (int axis = 1; axis < dim; ++axis) {
      const double* u = velocity[axis].data();
      sum += row_of<dim>(u, row.begin).abs().max(row_of<dim>(u, row.neighbors[2 * axis + 1]).abs());
    }
    largest_in_rows = largest_in_rows.max(sum);
  });
  largest = std::max(largest, largest_in_rows.maxCoeff());
  largest_speed_ = max_all(domain.grid.comm(), largest);
  return *largest_speed_;
}

template <int dim>
std::vector<StoredField> MacFlow<dim>::rates() {
  if (history)
    return history->fields();
  return advection_history ? advection_history->fields() : std::vector<StoredField>();
}

template <int dim>
void MacFlow<dim>::take_kicks() {
  if (!history)
    return;
  const std::vector<StoredField> gone = history->fields();
  const auto is_gone = [&gone](const StoredField& field) {
    return std::any_of(gone.begin(), gone.end(), [&field](const StoredField& one) {
      return one.components == field.components;
    });
  };
  fields.erase(std::remove_if(fields.begin(), fields.end(), is_gone), fields.end());
  history.reset();
  advection_history.emplace(domain.grid);
  for (StoredField& field : rates())
    fields.push_back(std::move(field));
}

template <int dim>
void MacFlow<dim>::save(CheckpointWriter& checkpoint) const {
  save_fields(domain, fields, checkpoint);
  CellField cells(domain.grid.n_stored_cells(), static_cast<double>(CellState::outside));
  std::transform(accepted_cells.begin(), accepted_cells.end(), cells.begin(),
                 [](CellState state) { return static_cast<double>(state); });
  save_fields(domain, {{"cells_with_pressure", {&cells}}}, checkpoint);
  checkpoint.file().write_attribute("fluid", "boundary_time", time);
  checkpoint.file().write_attribute("fluid", "last_step", last_step);
  checkpoint.file().write_attribute("fluid", "gravity_time", parameters.forces.gravity_time);
  if (liquid)
    liquid->interface().save(checkpoint);
}

namespace {
/// Bubbles are counted by their numbers, and what they hold is shared out by its amounts
/// (GasBubbles::fields).
void check_gas(const std::vector<StoredField>& fields, const CheckpointReader& checkpoint) {
  constexpr double most = GasBubbles<2>::most;
  const auto is_number = [](double number) {
    return number >= -1 && number <= most && number == std::floor(number);
  };
  const auto is_amount = [](double amount) { return amount >= 0; };
  for (const StoredField& field : fields) {
    const CellField& values = *field.components.front();
    checkpoint.check(
        (field.name != "gas_bubble" || std::all_of(values.begin(), values.end(), is_number)) &&
            (field.name != "gas_amount" || std::all_of(values.begin(), values.end(), is_amount)),
        "the numbers or amounts of its gas cannot be");
  }
}
}  // namespace

template <int dim>
void MacFlow<dim>::load(const CheckpointReader& checkpoint) {
  load_fields(domain, fields, checkpoint);
  check_gas(fields, checkpoint);
  prediction = velocity;
  scaled_pressure = accepted_pressure;
  CellField cells(domain.grid.n_stored_cells(), static_cast<double>(CellState::outside));
  load_fields(domain, {{"cells_with_pressure", {&cells}}}, checkpoint);
  const auto is_state = [](double state) {
    return state >= 0 && state <= static_cast<double>(CellState::air) && state == std::floor(state);
  };
  checkpoint.check(std::all_of(cells.begin(), cells.end(), is_state),
                   "the kinds of its cells cannot be");
  accepted_cells.resize(cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    accepted_cells[cell] = static_cast<CellState>(static_cast<int>(cells[cell]));
  time = checkpoint.file().read_attribute<double>("fluid", "boundary_time");
  last_step = checkpoint.file().read_attribute<double>("fluid", "last_step");
  checkpoint.check(last_step >= 0,
                   fmt::format("the last step of its fluid is {} s long", last_step));
  accepted_step = last_step;
  const auto gravity_time = checkpoint.file().read_attribute<double>("fluid", "gravity_time");
  checkpoint.check(std::isfinite(gravity_time), "the time of its gravity cannot be");
  parameters.forces.set_time(gravity_time);
  accepted_acceleration = parameters.forces.uniform();
  if (liquid)
    liquid->load(checkpoint);
  forget_speed();
}

template struct MacFlow<2>;
template struct MacFlow<3>;

}  // namespace lockstep
