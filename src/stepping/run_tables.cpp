#include "stepping/run_tables.hpp"

#include <algorithm>

namespace lockstep {
namespace {

const char* const axes[] = {"x", "y", "z"};

/// name_x, name_y(, name_z)
template <int dim>
void add_vector(std::vector<HistoryColumn>& columns, const std::string& name,
                const std::string& unit, const std::string& description) {
  for (int a = 0; a < dim; ++a)
    columns.push_back({name + axes[a], unit, description});
}

/// wz in 2D, wx wy wz in 3D
template <int dim>
void add_rotation(std::vector<HistoryColumn>& columns, const std::string& name,
                  const std::string& unit, const std::string& description) {
  for (int r = 0; r < n_rotations<dim>; ++r) {
    columns.push_back({name + axes[dim == 2 ? 2 : r], unit, description});
  }
}

template <typename Values>
void append_values(std::vector<HistoryValue>& row, const Values& values) {
  for (int a = 0; a < values.size(); ++a)
    row.push_back(double(values[a]));
}

/// One after another; a braced list of variants makes GCC 12 warn of uninitialised strings.
template <typename... Values>
void append_each(std::vector<HistoryValue>& row, const Values&... values) {
  (row.emplace_back(values), ...);
}

template <int dim>
std::vector<HistoryColumn> history_columns() {
  std::vector<HistoryColumn> columns = {
      {"step", "1", "number of the step"},
      {"time", "s", "at the end of the step"},
      {"dt", "s", "time step"},
      {"cfl", "1", "dt times the largest sum of |u|/h at the start of the step"},
      {"s1_iterations", "1", "coupled solve for the positions"},
      {"f2_iterations", "1", "Poisson solve of the advection velocity"},
      {"s2_iterations", "1", "coupled solve for the velocities"},
      {"viscous_iterations", "1", "implicit viscosity, both solves"},
      {"max_divergence", "1/s", "largest divergence of a cell after the step"},
      {"liquid_volume", dim == 2 ? "m^2" : "m^3", "of the fluid cells"}};
  add_vector<dim>(columns, "fluid_momentum_", "kg m/s", "fluid, lumped fluid included");
  add_vector<dim>(columns, "solid_momentum_", "kg m/s", "all dynamic solids");
  add_vector<dim>(columns, "boundary_impulse_", "kg m/s",
                  "pressure and friction of walls and sides");
  add_vector<dim>(columns, "transport_change_", "kg m/s",
                  "advection, revalidation, occlusion resets, change of lumped masses");
  add_rotation<dim>(columns, "lever_impulse_", "kg m^2/s",
                    "soft solids take forces at their nodes, fluid gives them at its faces");
  add_rotation<dim>(columns, "linearisation_impulse_", "kg m^2/s",
                    "torque over dt of forces that were linearised");
  for (HistoryColumn column : std::vector<HistoryColumn>{
           {"solid_iterations", "1", "inner ones on the solids' block, both solves"},
           {"momentum_error", "1", "audit: imbalance over the largest momentum or impulses"},
           {"angular_momentum_error", "1", "the same for angular momentum (0 if periodic)"},
           {"fluid_kinetic_energy", "J", ""},
           {"solid_kinetic_energy", "J", ""},
           {"elastic_energy", "J", ""},
           {"s1_residual", "1", "largest block residual of S1"},
           {"f2_residual", "1", "residual of F2"},
           {"s2_residual", "1", "largest block residual of S2"},
           {"incompatibility", "1", "part of the S2 right-hand side removed as incompatible"},
           {"f2_incompatibility", "1", "the same of F2"},
           {"contacts", "1", "contact points resolved for the positions"},
           {"deepest_overlap", "m", "before contact was resolved"},
           {"clamped_elements", "1", "elements of soft solids whose forces were made definite"},
           {"wall_seconds", "s", "wall time of the step"}}) {
    columns.push_back(column);
  }
  return columns;
}

template <int dim>
std::vector<HistoryColumn> body_columns() {
  std::vector<HistoryColumn> columns = {{"step", "1", "number of the step"},
                                        {"time", "s", "at the end of the step"},
                                        {"name", "1", "of the solid"}};
  add_vector<dim>(columns, "", "m", "centre of mass");
  add_vector<dim>(columns, "v", "m/s", "velocity of the centre of mass");
  add_rotation<dim>(columns, "w", "rad/s", "angular velocity");
  add_vector<dim>(columns, "f", "N", "hydrodynamic force, mean over the step");
  add_rotation<dim>(columns, "t", "N m", "hydrodynamic torque about the centre of mass");
  return columns;
}

}  // namespace

template <int dim>
RunTables<dim>::RunTables(const Communicator& comm, const std::string& directory)
    : history_(comm, directory + "/history.csv", history_columns<dim>()),
      bodies_(comm, directory + "/bodies.csv", body_columns<dim>()) {}

template <int dim>
void RunTables<dim>::start() {
  history_.start();
  bodies_.start();
}

template <int dim>
void RunTables<dim>::resume(long long step) {
  history_.resume(step);
  bodies_.resume(step);
}

template <int dim>
void RunTables<dim>::append(long long step, const StepReport<dim>& report,
                            const std::vector<SolidState<dim>>& states, double wall_seconds) {
  std::vector<HistoryValue> row;
  append_each(
      row, step, report.time, report.dt, report.cfl, static_cast<long long>(report.s1.iterations),
      static_cast<long long>(report.f2.iterations), static_cast<long long>(report.s2.iterations),
      static_cast<long long>(report.viscous_iterations), report.max_divergence,
      report.fluid_volume);
  append_values(row, report.fluid_momentum.linear);
  append_values(row, report.solid_momentum.linear);
  append_values(row, report.boundary_impulse.linear);
  append_values(row, report.transport_change.linear);
  append_values(row, report.lever_impulse);
  append_values(row, report.linearisation_impulse);
  append_each(row, static_cast<long long>(report.s1.solid_iterations + report.s2.solid_iterations));
  const auto residual = [](const SolveReport& solve) {
    return std::max(solve.pressure_residual, solve.solid_residual);
  };
  append_each(row, report.momentum_error, report.angular_momentum_error,
              report.fluid_kinetic_energy, report.solid_kinetic_energy, report.elastic_energy,
              residual(report.s1), residual(report.f2), residual(report.s2),
              report.incompatibility_s2, report.incompatibility_f2,
              static_cast<long long>(report.contact_position.n_contacts),
              report.contact_position.deepest_overlap,
              static_cast<long long>(report.n_clamped_elements), wall_seconds);
  history_.append_row(row);

  std::vector<std::vector<HistoryValue>> rows;
  for (std::size_t s = 0; s < states.size(); ++s) {
    const SolidState<dim>& state = states[s];
    const Momentum<dim>& impulse = report.hydrodynamic_impulse[s];
    std::vector<HistoryValue> body;
    append_each(body, step, report.time, state.name);
    append_values(body, state.center_of_mass);
    append_values(body, state.velocity);
    append_values(body, state.angular_velocity);
    append_values(body, Point<dim>(impulse.linear / report.dt));
    append_values(body, AngularVector<dim>(
                            (impulse.angular - cross<dim>(state.center_of_mass, impulse.linear)) /
                            report.dt));
    rows.push_back(std::move(body));
  }
  bodies_.append_rows(rows);
}

template <int dim>
StepProgress progress_of(long long step, const StepReport<dim>& report, double wall_seconds) {
  StepProgress progress;
  progress.step = step;
  progress.time = report.time;
  progress.time_step = report.dt;
  progress.cfl = report.cfl;
  progress.iterations = {
      {"S1", report.s1.iterations}, {"F2", report.f2.iterations}, {"S2", report.s2.iterations}};
  progress.max_divergence = report.max_divergence;
  progress.momentum_error = report.momentum_error;
  progress.wall_seconds = wall_seconds;
  return progress;
}

template class RunTables<2>;
template class RunTables<3>;
template StepProgress progress_of<2>(long long, const StepReport<2>&, double);
template StepProgress progress_of<3>(long long, const StepReport<3>&, double);

}  // namespace lockstep
