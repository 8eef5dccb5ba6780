#include "stepping/run_tables.hpp"

#include <algorithm>

#include "output/run_columns.hpp"

namespace lockstep {
namespace {

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

}  // namespace

template <int dim>
RunTables<dim>::RunTables(const Communicator& comm, const std::string& directory,
                          const LiquidFluid<dim>* liquid, bool with_joints)
    : history_(comm, directory + "/history.csv",
               history_columns<dim>(liquid != nullptr,
                                    liquid ? liquid->watch_names() : std::vector<std::string>(),
                                    liquid && liquid->traps_gas(), liquid && liquid->has_drops())),
      bodies_(comm, directory + "/bodies.csv", body_columns<dim>()) {
  if (with_joints)
    joints_.emplace(comm, directory + "/joints.csv", joint_columns());
}

template <int dim>
void RunTables<dim>::start() {
  history_.start();
  bodies_.start();
  if (joints_)
    joints_->start();
}

template <int dim>
void RunTables<dim>::check_columns() const {
  history_.check_columns();
  bodies_.check_columns();
  if (joints_)
    joints_->check_columns();
}

template <int dim>
void RunTables<dim>::resume(long long step) {
  history_.resume(step);
  bodies_.resume(step);
  if (joints_)
    joints_->resume(step);
}

template <int dim>
std::vector<HistoryValue> history_row(long long step, const StepReport<dim>& report,
                                      double wall_seconds) {
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
              report.viscous_dissipation, residual(report.s1), residual(report.f2),
              residual(report.s2), report.incompatibility_s2, report.incompatibility_f2,
              static_cast<long long>(report.contact_position.n_contacts),
              report.contact_position.deepest_overlap,
              static_cast<long long>(report.n_clamped_elements), wall_seconds);
  if (const auto& liquid = report.liquid) {
    append_each(row, liquid->target, liquid->shift, liquid->lost, liquid->n_bodies);
    for (const WatchedLiquid& watched : liquid->watches)
      append_each(row, watched.volume, watched.target, watched.leak);
    if (liquid->gas)
      append_each(row, liquid->gas->n_pockets, liquid->gas->volume, liquid->gas->pressure);
    if (liquid->drops)
      append_each(row, liquid->drops->n, liquid->drops->volume);
  }
  return row;
}

template <int dim>
void RunTables<dim>::append(long long step, const StepReport<dim>& report,
                            const std::vector<SolidState<dim>>& states, double wall_seconds) {
  history_.append_row(history_row(step, report, wall_seconds));
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
void RunTables<dim>::append_joints(long long step, double time,
                                   const std::vector<JointState>& joints,
                                   const std::vector<char>& limited) {
  std::vector<std::vector<HistoryValue>> rows;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const JointState& joint = joints[k];
    std::vector<HistoryValue> row;
    const std::string number = joint.coordinate > 0 ? " " + std::to_string(joint.coordinate) : "";
    append_each(row, step, time, joint.name + number, joint.q, joint.rate, joint.target,
                joint.torque, joint.power, joint.limit_torque, joint.gap,
                static_cast<long long>(joint.two_halves ? 1 : 0),
                static_cast<long long>(joint.at_limit ? 1 : 0),
                static_cast<long long>(limited[k] != 0 ? 1 : 0));
    rows.push_back(std::move(row));
  }
  joints_->append_rows(rows);
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
template std::vector<HistoryValue> history_row<2>(long long, const StepReport<2>&, double);
template std::vector<HistoryValue> history_row<3>(long long, const StepReport<3>&, double);
template StepProgress progress_of<2>(long long, const StepReport<2>&, double);
template StepProgress progress_of<3>(long long, const StepReport<3>&, double);

}  // namespace lockstep
