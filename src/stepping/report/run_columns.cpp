#include "stepping/report/run_columns.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "interfaces/constraint.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/solid_sides.hpp"
#include "stepping/report/step_report.hpp"

namespace lockstep {

namespace {

template <typename Row>
using Columns = std::vector<TableColumn<Row>>;

template <typename Row>
Columns<Row> step_and_time() {
  return {
      {{"step", "1", "number of the step"}, [](const Row& row) { return row.step; }},
      {{"time", "s", "at the end of the step"}, [](const Row& row) { return row.report.time; }}};
}

template <typename Row>
void append(Columns<Row>& columns, const Columns<Row>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
}

/// name_x, name_y(, name_z). `vector`: of a row, by value.
template <int dim, typename Row, typename Vector>
void add_vector(Columns<Row>& columns, const std::string& name, const std::string& unit,
                const std::string& description, const Vector& vector) {
  for (int a = 0; a < dim; ++a)
    columns.push_back({{name + axis_names[a], unit, description},
                       [vector, a](const Row& row) { return double(vector(row)[a]); }});
}

/// wz in 2D, wx wy wz in 3D
template <int dim, typename Row, typename Vector>
void add_rotation(Columns<Row>& columns, const std::string& name, const std::string& unit,
                  const std::string& description, const Vector& vector) {
  for (int r = 0; r < n_rotations<dim>; ++r)
    columns.push_back({{name + axis_names[dim == 2 ? 2 : r], unit, description},
                       [vector, r](const Row& row) { return double(vector(row)[r]); }});
}

double residual(const SolveReport& solve) {
  return std::max(solve.pressure_residual, solve.solid_residual);
}

template <int dim>
const char* volume_unit() {
  return dim == 2 ? "m^2" : "m^3";
}

template <int dim>
void add_solves(Columns<HistoryRow<dim>>& columns) {
  using Row = HistoryRow<dim>;
  append<Row>(columns, {{{"dt", "s", "time step"}, [](const Row& row) { return row.report.dt; }},
                        {{"cfl", "1", "dt times the largest sum of |u|/h at the start of the step"},
                         [](const Row& row) { return row.report.cfl; }},
                        {{"s1_iterations", "1", "coupled solve for the positions"},
                         [](const Row& row) { return row.report.s1.iterations; }},
                        {{"f2_iterations", "1", "Poisson solve of the advection velocity"},
                         [](const Row& row) { return row.report.f2.iterations; }},
                        {{"s2_iterations", "1", "coupled solve for the velocities"},
                         [](const Row& row) { return row.report.s2.iterations; }},
                        {{"viscous_iterations", "1", "implicit viscosity, both solves"},
                         [](const Row& row) { return row.report.viscous_iterations; }},
                        {{"max_divergence", "1/s", "largest divergence of a cell after the step"},
                         [](const Row& row) { return row.report.max_divergence; }},
                        {{"liquid_volume", volume_unit<dim>(),
                          "of the fluid cells; below the free surface, if there is one"},
                         [](const Row& row) { return row.report.fluid_volume; }}});
}

template <int dim>
void add_momentum(Columns<HistoryRow<dim>>& columns) {
  using Row = HistoryRow<dim>;
  add_vector<dim>(columns, "fluid_momentum_", "kg m/s", "fluid, lumped fluid included",
                  [](const Row& row) { return row.report.fluid_momentum.linear; });
  add_vector<dim>(columns, "solid_momentum_", "kg m/s", "all dynamic solids",
                  [](const Row& row) { return row.report.solid_momentum.linear; });
  add_vector<dim>(columns, "boundary_impulse_", "kg m/s",
                  "pressure and friction of walls and sides",
                  [](const Row& row) { return row.report.boundary_impulse.linear; });
  add_vector<dim>(columns, "transport_change_", "kg m/s",
                  "advection, uncovered, occlusion resets, change of lumped masses",
                  [](const Row& row) { return row.report.transport_change.linear; });
  add_rotation<dim>(columns, "lumping_torque_error_", "kg m^2/s",
                    "soft solids take forces at their nodes, fluid gives them at its faces",
                    [](const Row& row) { return row.report.lumping_torque_error; });
  add_rotation<dim>(columns, "linearisation_impulse_", "kg m^2/s",
                    "torque over dt of forces that were linearised",
                    [](const Row& row) { return row.report.linearisation_impulse; });
}

template <int dim>
void add_audit(Columns<HistoryRow<dim>>& columns) {
  using Row = HistoryRow<dim>;
  append<Row>(
      columns,
      {{{"solid_iterations", "1", "inner ones on the solids' block, both solves"},
        [](const Row& row) {
          return row.report.s1.solid_iterations + row.report.s2.solid_iterations;
        }},
       {{"momentum_error", "1",
         "audit: imbalance over the largest momentum or impulses; nan where a plug-in has none",
         true},
        [](const Row& row) { return row.report.momentum_error; }},
       {{"angular_momentum_error", "1", "the same for angular momentum (0 if periodic)", true},
        [](const Row& row) { return row.report.angular_momentum_error; }},
       {{"fluid_kinetic_energy", "J", ""},
        [](const Row& row) { return row.report.fluid_kinetic_energy; }},
       {{"solid_kinetic_energy", "J", ""},
        [](const Row& row) { return row.report.solid_kinetic_energy; }},
       {{"elastic_energy", "J", ""}, [](const Row& row) { return row.report.elastic_energy; }},
       {{"viscous_dissipation", "W",
         "of the friction in the fluid and on solids, less what moving sides give it"},
        [](const Row& row) { return row.report.viscous_dissipation; }},
       {{"s1_residual", "1", "largest block residual of S1"},
        [](const Row& row) { return residual(row.report.s1); }},
       {{"f2_residual", "1", "residual of F2"},
        [](const Row& row) { return residual(row.report.f2); }},
       {{"s2_residual", "1", "largest block residual of S2"},
        [](const Row& row) { return residual(row.report.s2); }},
       {{"incompatibility", "1", "part of the S2 right-hand side removed as incompatible"},
        [](const Row& row) { return row.report.incompatibility_s2; }},
       {{"f2_incompatibility", "1", "the same of F2"},
        [](const Row& row) { return row.report.incompatibility_f2; }},
       {{"contacts", "1", "contact points resolved for the positions"},
        [](const Row& row) { return row.report.contact_position.n_contacts; }},
       {{"deepest_overlap", "m", "before contact was resolved"},
        [](const Row& row) { return row.report.contact_position.deepest_overlap; }},
       {{"contact_solves", "1", "coupled solves of S1 and S2 that held contacts"},
        [](const Row& row) {
          return row.report.contact_position.n_solves + row.report.contact_velocity.n_solves;
        }},
       {{"contacts_outside", "1", "phases of the step in which contacts acted outside of these"},
        [](const Row& row) {
          return row.report.contact_position.n_outside + row.report.contact_velocity.n_outside;
        }},
       {{"contact_residual", "m/s", "velocity at contacts that the last of these solves has left"},
        [](const Row& row) {
          return std::max(row.report.contact_position.residual,
                          row.report.contact_velocity.residual);
        }},
       {{"clamped_elements", "1", "elements of soft solids whose forces were made definite"},
        [](const Row& row) { return row.report.n_clamped_elements; }},
       {{"wall_seconds", "s", "wall time of the step"},
        [](const Row& row) { return row.wall_seconds; }}});
}

/// Throws unless a fluid reports all that it has said it would.
void check_told(bool is_told) {
  check_output(is_told,
               "The fluid does not report all that it said it would of its liquid, and history.csv "
               "has columns for it.");
}

template <typename Part>
const Part& reported(const std::optional<Part>& part) {
  check_told(part.has_value());
  return *part;
}

template <int dim>
const LiquidReport& liquid_in(const HistoryRow<dim>& row) {
  return reported(row.report.liquid);
}

template <int dim>
void add_watch(Columns<HistoryRow<dim>>& columns, const std::string& name, std::size_t number) {
  using Row = HistoryRow<dim>;
  const auto add = [&](const std::string& suffix, const std::string& description,
                       double WatchedLiquid::*value) {
    columns.push_back({{"watch_" + name + suffix, volume_unit<dim>(), description, true},
                       [number, value](const Row& row) {
                         const std::vector<WatchedLiquid>& watches = liquid_in(row).watches;
                         check_told(number < watches.size());
                         return watches[number].*value;
                       }});
  };
  add("_volume", "of liquid in this watched place; nan, as the next, while it is not watched",
      &WatchedLiquid::volume);
  add("_volume_target", "what it should be", &WatchedLiquid::target);
}

template <int dim>
void add_liquid(Columns<HistoryRow<dim>>& columns, const LiquidColumns& liquid) {
  using Row = HistoryRow<dim>;
  const std::string unit = volume_unit<dim>();
  append<Row>(columns,
              {{{"liquid_volume_target", unit, "what known fluxes have left of that of the start"},
                [](const Row& row) { return liquid_in(row).target; }},
               {{"volume_shift", unit, "what corrections have added and taken away so far"},
                [](const Row& row) { return liquid_in(row).shift; }},
               {{"lost_volume", unit, "of bodies of liquid that became too small to see"},
                [](const Row& row) { return liquid_in(row).lost; }},
               {{"liquid_bodies", "1", "connected bodies of liquid"},
                [](const Row& row) { return liquid_in(row).n_bodies; }}});
  for (std::size_t w = 0; w < liquid.watches.size(); ++w)
    add_watch(columns, liquid.watches[w], w);
  if (liquid.gas)
    append<Row>(columns, {{{"gas_bubbles", "1", "of air that the atmosphere does not reach"},
                           [](const Row& row) { return reported(liquid_in(row).gas).n_bubbles; }},
                          {{"gas_volume", unit, "of them all"},
                           [](const Row& row) { return reported(liquid_in(row).gas).volume; }},
                          {{"gas_pressure", "Pa", "in the largest, above the atmosphere's"},
                           [](const Row& row) { return reported(liquid_in(row).gas).pressure; }}});
  if (liquid.drops)
    append<Row>(columns, {{{"drops", "1", "of liquid, which fly beside it"},
                           [](const Row& row) { return reported(liquid_in(row).drops).n; }},
                          {{"drops_volume", unit, "of them all; no part of the liquid's"},
                           [](const Row& row) { return reported(liquid_in(row).drops).volume; }}});
}

}  // namespace

template <int dim>
std::vector<TableColumn<HistoryRow<dim>>> history_columns(
    const std::optional<LiquidColumns>& liquid) {
  Columns<HistoryRow<dim>> columns = step_and_time<HistoryRow<dim>>();
  add_solves<dim>(columns);
  add_momentum<dim>(columns);
  add_audit<dim>(columns);
  if (liquid)
    add_liquid<dim>(columns, *liquid);
  return columns;
}

template <int dim>
MeanForce<dim> mean_force(const Momentum<dim>& impulse, const Point<dim>& center, double dt) {
  const AngularVector<dim> moved = cross<dim>(center, impulse.linear);
  return {impulse.linear / dt, (impulse.angular - moved) / dt};
}

namespace {
template <int dim>
MeanForce<dim> of_row(const BodyRow<dim>& row, const Momentum<dim>& impulse) {
  return mean_force<dim>(impulse, row.state.center_of_mass, row.report.dt);
}
}  // namespace

template <int dim>
std::vector<TableColumn<BodyRow<dim>>> body_columns() {
  using Row = BodyRow<dim>;
  Columns<Row> columns = step_and_time<Row>();
  columns.push_back({{"name", "1", "of the solid"}, [](const Row& row) { return row.state.name; }});
  add_vector<dim>(columns, "", "m", "centre of mass",
                  [](const Row& row) { return row.state.center_of_mass; });
  add_vector<dim>(columns, "v", "m/s", "velocity of the centre of mass",
                  [](const Row& row) { return row.state.velocity; });
  add_rotation<dim>(columns, "w", "rad/s", "angular velocity",
                    [](const Row& row) { return row.state.angular_velocity; });
  const auto add = [&](const std::string& prefix, const std::string& what, auto impulse_of) {
    add_vector<dim>(columns, prefix + "f", "N", what + " force, mean over the step",
                    [impulse_of](const Row& row) { return of_row(row, impulse_of(row)).force; });
    add_rotation<dim>(columns, prefix + "t", "N m", what + " torque about the centre of mass",
                      [impulse_of](const Row& row) { return of_row(row, impulse_of(row)).torque; });
  };
  add("", "hydrodynamic", [](const Row& row) { return row.impulse; });
  add("contact_", "contact's and joint limits'", [](const Row& row) { return row.of_contact; });
  return columns;
}

template <int dim>
std::vector<TableColumn<JointRow<dim>>> joint_columns() {
  using Row = JointRow<dim>;
  Columns<Row> columns = step_and_time<Row>();
  append<Row>(
      columns,
      {{{"name", "1", "of the joint; with the number of the coordinate if it has several"},
        [](const Row& row) {
          const int number = row.joint.coordinate;
          return row.joint.name + (number > 0 ? " " + std::to_string(number) : "");
        }},
       {{"q", "rad, m", "the coordinate, 0 at the start"},
        [](const Row& row) { return row.joint.q; }},
       {{"rate", "rad/s, m/s", "its rate"}, [](const Row& row) { return row.joint.rate; }},
       {{"target", "rad, m", "where control wants it at that time; without control as q"},
        [](const Row& row) { return row.joint.target; }},
       {{"torque", "N m, N", "of control on the second solid, mean over the step"},
        [](const Row& row) { return row.joint.torque; }},
       {{"power", "W", "of control, mean over the step"},
        [](const Row& row) { return row.joint.power; }},
       {{"limit_torque", "N m, N", "of limits on the second solid, mean over the step"},
        [](const Row& row) { return row.joint.limit_torque; }},
       {{"gap", "m, rad", "how far the joint is open"},
        [](const Row& row) { return row.joint.gap; }},
       {{"two_halves", "1", "1: half of its impulse acted where the step began; 0: none did"},
        [](const Row& row) { return row.joint.two_halves ? 1 : 0; }},
       {{"at_limit", "1", "1: the coordinate is at a limit, or beyond"},
        [](const Row& row) { return row.joint.at_limit ? 1 : 0; }},
       {{"limited", "1", "1: the torque is the largest that control may give"},
        [](const Row& row) { return row.joint.at_largest_torque ? 1 : 0; }}});
  return columns;
}

template <int dim>
std::vector<TableColumn<LineRow<dim>>> line_columns() {
  using Row = LineRow<dim>;
  Columns<Row> columns = step_and_time<Row>();
  append<Row>(
      columns,
      {{{"name", "1", "of the line"}, [](const Row& row) { return row.line.name; }},
       {{"span", "m", "distance of its ends"}, [](const Row& row) { return row.line.span; }},
       {{"first_tension", "N", "at its first end; below 0 it pushes"},
        [](const Row& row) { return row.line.tension[0]; }},
       {{"second_tension", "N", "at its second end"},
        [](const Row& row) { return row.line.tension[1]; }}});
  return columns;
}

template std::vector<TableColumn<HistoryRow<2>>> history_columns(
    const std::optional<LiquidColumns>&);
template std::vector<TableColumn<HistoryRow<3>>> history_columns(
    const std::optional<LiquidColumns>&);
template MeanForce<2> mean_force(const Momentum<2>&, const Point<2>&, double);
template MeanForce<3> mean_force(const Momentum<3>&, const Point<3>&, double);
template std::vector<TableColumn<BodyRow<2>>> body_columns();
template std::vector<TableColumn<BodyRow<3>>> body_columns();
template std::vector<TableColumn<JointRow<2>>> joint_columns();
template std::vector<TableColumn<JointRow<3>>> joint_columns();
template std::vector<TableColumn<LineRow<2>>> line_columns();
template std::vector<TableColumn<LineRow<3>>> line_columns();

}  // namespace lockstep
