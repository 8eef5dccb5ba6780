#include "rigid/body_load.hpp"

#include "base/errors.hpp"
#include "motion/list_values.hpp"
#include "motion/timed_table.hpp"
#include "parameters/field_formula.hpp"

namespace lockstep {

namespace {

template <int dim>
ParameterList load_table_schema() {
  ParameterList table;
  declare_times(table);
  declare_optional<ParameterArray<double>>(
      table, "Forces",
      "Force [N] (2D: [N/m]): a vector for each time, one after another. Absent: none.");
  declare_optional<ParameterArray<double>>(
      table, "Torques",
      dim == 2 ? "Torque for each time [N]. Absent: none."
               : "Torque [N m]: a vector for each time, one after another. Absent: none.");
  return table;
}

template <int dim>
ParameterList load_formula_schema() {
  ParameterList formula;
  declare_optional<ParameterArray<std::string>>(
      formula, "Forces",
      "A formula for each component of the force [N] (2D: [N/m]). Absent: none.");
  set_length(formula, "Forces", dim);
  declare_optional<ParameterArray<std::string>>(
      formula, "Torques",
      dim == 2 ? "A formula for the torque [N]. Absent: none."
               : "A formula for each component of the torque [N m]. Absent: none.");
  set_length(formula, "Torques", n_rotations<dim>);
  return formula;
}

template <int dim>
LoadLaw<dim> load_from_table(const ParameterList& list, const std::string& where) {
  const std::vector<double> times = read_times(list, where);
  const auto forces = read_columns(list, "Forces", times, dim, where);
  const auto torques = read_columns(list, "Torques", times, n_rotations<dim>, where);
  check_input(!forces.empty() || !torques.empty(),
              "In \"{}\", the table pushes nothing: give it \"Forces\" or \"Torques\".", where);
  return [forces, torques](double time, const Point<dim>&) {
    Load<dim> load;
    for (std::size_t a = 0; a < forces.size(); ++a)
      load.force[a] = forces[a].value(time);
    for (std::size_t a = 0; a < torques.size(); ++a)
      load.torque[a] = torques[a].value(time);
    return load;
  };
}

template <int dim>
LoadLaw<dim> load_from_formulas(const ParameterList& list, const std::string& where) {
  const auto read = [&](const char* name) {
    return FieldFormula<dim>(list.isParameter(name)
                                 ? list.get<ParameterArray<std::string>>(name).toVector()
                                 : std::vector<std::string>(),
                             where + "/" + name);
  };
  const FieldFormula<dim> forces = read("Forces"), torques = read("Torques");
  check_input(forces.n_components() + torques.n_components() > 0,
              "In \"{}\", the formulas push nothing: give it \"Forces\" or \"Torques\".", where);
  return [forces, torques](double time, const Point<dim>& x) {
    Load<dim> load;
    for (int a = 0; a < forces.n_components(); ++a)
      load.force[a] = forces(a, x, time);
    for (int a = 0; a < torques.n_components(); ++a)
      load.torque[a] = torques(a, x, time);
    return load;
  };
}

}  // namespace

template <int dim>
void declare_load(ParameterList& body) {
  declare_vector(body, "Force", ParameterArray<double>(dim, 0.0), dim,
                 "Constant load at the centre of mass, besides gravity [N] (2D: [N/m]).");
  declare_rotation<dim>(body, "Torque", "Constant load, in axes of space [N m] (2D: [N]).");
  declare_typed_sublist(
      body, "Load", "Force at the centre of mass and torque besides gravity, in axes of space.",
      {{"constant", "\"Force\" and \"Torque\".", ParameterList()},
       {"table",
        "Follows a table in time through a monotone cubic interpolation, and stays before and "
        "after.",
        load_table_schema<dim>()},
       {"formula",
        dim == 2 ? "Formulas of the place x, y of the centre of mass [m] and the time t [s], such "
                   "as \"-4*x + 2*sin(3*t)\"."
                 : "Formulas of the place x, y, z of the centre of mass [m] and the time t [s], "
                   "such as \"-4*x + 2*sin(3*t)\".",
        load_formula_schema<dim>()}},
      "constant");
}

template <int dim>
LoadLaw<dim> read_load(const ParameterList& body, const std::string& name, bool dynamic) {
  const Load<dim> constant{vector_value<dim>(body, "Force"), rotation_value<dim>(body, "Torque")};
  const bool is_given = !constant.force.isZero(0) || !constant.torque.isZero(0);
  const ParameterList& list = body.sublist("Load");
  const auto& type = list.get<std::string>("Type");
  check_input(
      dynamic || (!is_given && type == "constant"),
      "The solid \"{}\" follows a script, so a \"Force\", \"Torque\" or \"Load\" cannot move "
      "it; leave them out, or make its motion \"dynamic\".",
      name);
  if (type == "constant")
    return constant_load(constant);
  check_input(!is_given,
              "The solid \"{}\" has a \"Load\" of the type \"{}\", and \"Force\" or \"Torque\" "
              "besides; leave these out.",
              name, type);
  const std::string where = name + "/Load";
  return type == "table" ? load_from_table<dim>(list, where) : load_from_formulas<dim>(list, where);
}

template <int dim>
LoadLaw<dim> constant_load(const Load<dim>& load) {
  if (load.force.isZero(0) && load.torque.isZero(0))
    return {};
  return [load](double, const Point<dim>&) { return load; };
}

template void declare_load<2>(ParameterList&);
template void declare_load<3>(ParameterList&);
template LoadLaw<2> read_load<2>(const ParameterList&, const std::string&, bool);
template LoadLaw<3> read_load<3>(const ParameterList&, const std::string&, bool);
template LoadLaw<2> constant_load<2>(const Load<2>&);
template LoadLaw<3> constant_load<3>(const Load<3>&);

}  // namespace lockstep
