#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/momentum.hpp"
#include "stepping/report/row_table.hpp"

namespace lockstep {

struct JointState;
struct LineState;
template <int dim>
struct SolidState;
template <int dim>
struct StepReport;

/// Source of a row of history.csv: a step.
template <int dim>
struct HistoryRow {
  long long step;
  const StepReport<dim>& report;
  double wall_seconds;
};

/// Source of a row of bodies.csv: a step and a solid.
template <int dim>
struct BodyRow {
  long long step;
  const StepReport<dim>& report;
  const SolidState<dim>& state;
  const Momentum<dim>& impulse;  ///< hydrodynamic, over dt, angular about the origin
  Momentum<dim> of_contact;      ///< likewise, by contacts and limits of joints
};

/// Force [N] and torque about a point [N m], means over a step.
template <int dim>
struct MeanForce {
  Point<dim> force = Point<dim>::Zero();
  AngularVector<dim> torque = AngularVector<dim>::Zero();
};
/// Returns the mean of an impulse over dt [s], which is angular about the origin, about `center`.
template <int dim>
MeanForce<dim> mean_force(const Momentum<dim>& impulse, const Point<dim>& center, double dt);

/// Source of a row of joints.csv: a step and a coordinate.
template <int dim>
struct JointRow {
  long long step;
  const StepReport<dim>& report;
  const JointState& joint;
};

/// Source of a row of lines.csv: a step and a line.
template <int dim>
struct LineRow {
  long long step;
  const StepReport<dim>& report;
  const LineState& line;
};

/// Parts of the LiquidReport of a liquid with a free surface that have columns.
struct LiquidColumns {
  std::vector<std::string> watches;  ///< names
  bool gas = false, drops = false;
};

/// Columns of history.csv, bodies.csv, joints.csv and lines.csv: what is written, and what the
/// formulas of a study may name. Those of a liquid with a free surface stand at the end, then those
/// of its watched places, of trapped gas and of drops.
template <int dim>
std::vector<TableColumn<HistoryRow<dim>>> history_columns(
    const std::optional<LiquidColumns>& liquid);
template <int dim>
std::vector<TableColumn<BodyRow<dim>>> body_columns();
template <int dim>
std::vector<TableColumn<JointRow<dim>>> joint_columns();
template <int dim>
std::vector<TableColumn<LineRow<dim>>> line_columns();

}  // namespace lockstep
