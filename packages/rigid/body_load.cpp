#include "rigid/body_load.hpp"

#include "base/errors.hpp"
#include "motion/list_values.hpp"
#include "parameters/field_formula.hpp"
#include "parameters/formula.hpp"

namespace lockstep {

template <int dim>
void declare_load(ParameterList& body) {
  declare_vector(body, "Force", ParameterArray<double>(dim, 0.0), dim,
                 "Force at the centre of mass besides gravity, in axes of space [N] (2D: [N/m]); "
                 "formulas of where it is [m] and the time [s], such as \"[-4*x + 2*sin(3*t)]\" or "
                 "\"[table(t, 0, 0, 1, 5)]\".");
  declare_rotation<dim>(body, "Torque", "Torque likewise [N m] (2D: [N]).");
  for (const char* name : {"Force", "Torque"})
    set_variables(body, name, place_and_time(dim));
}

template <int dim>
LoadLaw<dim> read_load(const ParameterList& body, const std::string& name, bool dynamic) {
  const FieldFormula<dim> force(body, "Force", name), torque(body, "Torque", name);
  if (force.vanishes() && torque.vanishes())
    return {};
  check_input(dynamic,
              "The solid \"{}\" follows a script, so a \"Force\" or \"Torque\" cannot move it; "
              "leave them out, or make its motion \"dynamic\".",
              name);
  return [force, torque](double time, const Point<dim>& x) {
    Load<dim> load;
    for (int a = 0; a < dim; ++a)
      load.force[a] = force(a, x, time);
    for (int a = 0; a < n_rotations<dim>; ++a)
      load.torque[a] = torque(a, x, time);
    return load;
  };
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
