#include "output/run_columns.hpp"

#include "base/types.hpp"

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

}  // namespace

template <int dim>
std::vector<HistoryColumn> history_columns(bool with_liquid,
                                           const std::vector<std::string>& watches, bool with_gas,
                                           bool with_drops) {
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
      {"liquid_volume", dim == 2 ? "m^2" : "m^3",
       "of the fluid cells; below the free surface, if there is one"}};
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
           {"momentum_error", "1",
            "audit: imbalance over the largest momentum or impulses; nan where a plug-in has none",
            true},
           {"angular_momentum_error", "1", "the same for angular momentum (0 if periodic)", true},
           {"fluid_kinetic_energy", "J", ""},
           {"solid_kinetic_energy", "J", ""},
           {"elastic_energy", "J", ""},
           {"viscous_dissipation", "W",
            "of the friction in the fluid and on solids, less what moving sides give it"},
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
  if (with_liquid) {
    const std::string unit = dim == 2 ? "m^2" : "m^3";
    for (HistoryColumn column : std::vector<HistoryColumn>{
             {"liquid_volume_target", unit, "what known fluxes have left of that of the start"},
             {"volume_shift", unit, "what corrections have added and taken away so far"},
             {"lost_volume", unit, "of bodies of liquid that became too small to see"},
             {"liquid_bodies", "1", "connected bodies of liquid"}}) {
      columns.push_back(column);
    }
    for (const std::string& name : watches) {
      const std::string watch = "watch_" + name;
      columns.push_back(
          {watch + "_volume", unit,
           "of liquid in this watched place; nan, as the next two, while it is not watched"});
      columns.push_back({watch + "_volume_target", unit, "what it should be"});
      columns.push_back(
          {watch + "_leak", unit, "of it what came through solids: 0, or the run ends"});
    }
    if (with_gas)
      for (HistoryColumn column : std::vector<HistoryColumn>{
               {"gas_pockets", "1", "of void that the atmosphere does not reach"},
               {"gas_volume", unit, "of them all"},
               {"gas_pressure", "Pa", "in the largest, above the atmosphere's"}})
        columns.push_back(column);
    if (with_drops) {
      columns.push_back({"drops", "1", "of liquid, which fly beside it"});
      columns.push_back({"drops_volume", unit, "of them all; no part of the liquid's"});
    }
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

std::vector<HistoryColumn> joint_columns() {
  return {{"step", "1", "number of the step"},
          {"time", "s", "at the end of the step"},
          {"name", "1", "of the joint; with the number of the coordinate if it has several"},
          {"q", "rad, m", "the coordinate, 0 at the start"},
          {"rate", "rad/s, m/s", "its rate"},
          {"target", "rad, m", "where control wants it at that time; without control as q"},
          {"torque", "N m, N", "of control on the second solid, mean over the step"},
          {"power", "W", "of control, mean over the step"},
          {"limit_torque", "N m, N", "of limits on the second solid, mean over the step"},
          {"gap", "m, rad", "how far the joint is open"},
          {"two_halves", "1", "1: half of its impulse acted where the step began; 0: none did"},
          {"at_limit", "1", "1: the coordinate is at a limit, or beyond"},
          {"limited", "1", "1: the torque is the largest that control may give"}};
}

template std::vector<HistoryColumn> history_columns<2>(bool, const std::vector<std::string>&, bool,
                                                       bool);
template std::vector<HistoryColumn> history_columns<3>(bool, const std::vector<std::string>&, bool,
                                                       bool);
template std::vector<HistoryColumn> body_columns<2>();
template std::vector<HistoryColumn> body_columns<3>();

}  // namespace lockstep
