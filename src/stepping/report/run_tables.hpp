#pragma once
#include <optional>
#include <string>
#include <vector>

#include "output/history.hpp"
#include "output/progress.hpp"
#include "stepping/report/run_columns.hpp"
#include "stepping/report/step_report.hpp"

namespace lockstep {

/// history.csv (a row a step), bodies.csv (a row a step and solid), and, if there are any,
/// joints.csv (a row a step and coordinate) and lines.csv (a row a step and line).
template <int dim>
class RunTables {
 public:
  /// `liquid`: not null if all steps report a liquid with a free surface.
  RunTables(const Communicator& comm, const std::string& directory, const LiquidFluid<dim>* liquid,
            bool with_joints, bool with_lines);
  void start();
  /// Throws InputError if tables that are there have other columns.
  void check_columns() const;
  void resume(long long step);
  /// Collective. States as the SolidSystem gives them.
  void append(long long step, const StepReport<dim>& report,
              const std::vector<SolidState<dim>>& states, double wall_seconds);
  /// Likewise. Only with joints.
  void append_joints(long long step, const StepReport<dim>& report,
                     const std::vector<JointState>& joints);
  /// Likewise. Only with lines.
  void append_lines(long long step, const StepReport<dim>& report,
                    const std::vector<LineState>& lines);
  /// The row of a step in history.csv, by column. Local.
  std::vector<std::pair<std::string, HistoryValue>> history_row(long long step,
                                                                const StepReport<dim>& report,
                                                                double wall_seconds) const;

 private:
  RowTable<HistoryRow<dim>> history_;
  RowTable<BodyRow<dim>> bodies_;
  std::optional<RowTable<JointRow<dim>>> joints_;
  std::optional<RowTable<LineRow<dim>>> lines_;
};

/// The numbers of the progress line.
template <int dim>
StepProgress progress_of(long long step, const StepReport<dim>& report, double wall_seconds);

}  // namespace lockstep
