#include "stepping/report/run_tables.hpp"

#include "interfaces/constraint.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/solid_sides.hpp"

namespace lockstep {
namespace {

template <int dim>
std::optional<LiquidColumns> liquid_columns(const LiquidFluid<dim>* liquid) {
  if (!liquid)
    return std::nullopt;
  return LiquidColumns{liquid->watch_names(), liquid->traps_gas(), liquid->has_drops()};
}

}  // namespace

template <int dim>
RunTables<dim>::RunTables(const Communicator& comm, const std::string& directory,
                          const LiquidFluid<dim>* liquid, bool with_joints, bool with_lines)
    : history_(comm, directory + "/history.csv", history_columns<dim>(liquid_columns(liquid))),
      bodies_(comm, directory + "/bodies.csv", body_columns<dim>()) {
  if (with_joints)
    joints_.emplace(comm, directory + "/joints.csv", joint_columns<dim>());
  if (with_lines)
    lines_.emplace(comm, directory + "/lines.csv", line_columns<dim>());
}

template <int dim>
void RunTables<dim>::start() {
  history_.start();
  bodies_.start();
  if (joints_)
    joints_->start();
  if (lines_)
    lines_->start();
}

template <int dim>
void RunTables<dim>::check_columns() const {
  history_.check_columns();
  bodies_.check_columns();
  if (joints_)
    joints_->check_columns();
  if (lines_)
    lines_->check_columns();
}

template <int dim>
void RunTables<dim>::resume(long long step) {
  history_.resume(step);
  bodies_.resume(step);
  if (joints_)
    joints_->resume(step);
  if (lines_)
    lines_->resume(step);
}

template <int dim>
void RunTables<dim>::append(long long step, const StepReport<dim>& report,
                            const std::vector<SolidState<dim>>& states, double wall_seconds) {
  history_.append({{step, report, wall_seconds}});
  std::vector<BodyRow<dim>> rows;
  for (std::size_t s = 0; s < states.size(); ++s)
    rows.push_back({step, report, states[s], report.hydrodynamic_impulse[s],
                    report.contact_impulse.empty() ? Momentum<dim>() : report.contact_impulse[s]});
  bodies_.append(rows);
}

template <int dim>
void RunTables<dim>::append_joints(long long step, const StepReport<dim>& report,
                                   const std::vector<JointState>& joints) {
  std::vector<JointRow<dim>> rows;
  for (const JointState& joint : joints)
    rows.push_back({step, report, joint});
  joints_->append(rows);
}

template <int dim>
void RunTables<dim>::append_lines(long long step, const StepReport<dim>& report,
                                  const std::vector<LineState>& lines) {
  std::vector<LineRow<dim>> rows;
  for (const LineState& line : lines)
    rows.push_back({step, report, line});
  lines_->append(rows);
}

template <int dim>
std::vector<std::pair<std::string, HistoryValue>> RunTables<dim>::history_row(
    long long step, const StepReport<dim>& report, double wall_seconds) const {
  return history_.named({step, report, wall_seconds});
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
