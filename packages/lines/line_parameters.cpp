#include "lines/line_parameters.hpp"

#include "base/errors.hpp"
#include "lines/catenary.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

const std::string name_of_no_solid = "space";

template <int dim>
void declare_ends(ParameterList& list) {
  declare_required_vector<std::string>(
      list, "Solids", 2,
      "Two dynamic rigid bodies between which the line is, or one and \"space\".");
  declare_required_vector<double>(
      list, "Points", 2 * dim,
      "Places of the two ends at the start, in space [m]: one point after the other. They go with "
      "the bodies.");
}

template <int dim>
Line<dim> read_ends(const std::string& name, const ParameterList& list) {
  Line<dim> line;
  line.name = name;
  const auto& solids = list.get<ParameterArray<std::string>>("Solids");
  const auto points = vector_value<2 * dim>(list, "Points");
  for (int end = 0; end < 2; ++end) {
    line.solids[end] = solids[end] == name_of_no_solid ? "" : solids[end];
    line.ends[end] = points.template segment<dim>(dim * end);
  }
  check_input(line.solids[0] != line.solids[1],
              "The line \"{}\" connects \"{}\" with itself; name two.", name, solids[0]);
  return line;
}

}  // namespace

template <int dim>
ParameterList spring_parameters() {
  ParameterList list("spring");
  declare_ends<dim>(list);
  declare_at_least(list, "Stiffness", 0., 0., "Force by stretch [N/m] (2D: [N/m^2]).");
  declare_at_least(list, "Damping", 0., 0.,
                   "Force by the rate of the stretch, of a damper beside the spring [N s/m] (2D: "
                   "[N s/m^2]).");
  declare_optional<double>(list, "Length", "Length at rest [m]; default: that at the start.");
  set_at_least(list, "Length", 0);
  return list;
}

template <int dim>
ParameterList rope_parameters() {
  ParameterList list = spring_parameters<dim>();
  list.setName("rope");
  return list;
}

template <int dim>
ParameterList mooring_line_parameters() {
  ParameterList list("mooring line");
  declare_ends<dim>(list);
  declare_required_positive(list, "Length", "Length without tension [m].");
  declare_required_positive(list, "Weight",
                            "Weight in the fluid, less buoyancy, by length [N/m] (2D: [N/m^2]).");
  declare_required_positive(list, "Stiffness", "Tension by strain, EA [N] (2D: [N/m]).");
  declare(list, "On Floor", false,
          "The first end lies on level ground in space, and with it, without friction, what "
          "tension does not lift.");
  return list;
}

namespace {
template <int dim>
Line<dim> read_stretched(const std::string& name, const ParameterList& list, bool tension_only) {
  Line<dim> line = read_ends<dim>(name, list);
  SpringParameters spring;
  spring.stiffness = list.get<double>("Stiffness");
  spring.damping = list.get<double>("Damping");
  spring.length = list.isParameter("Length") ? list.get<double>("Length")
                                             : (line.ends[1] - line.ends[0]).norm();
  spring.tension_only = tension_only;
  check_input(spring.stiffness > 0 || spring.damping > 0,
              "The line \"{}\" has neither \"Stiffness\" nor \"Damping\"; give it one.", name);
  line.law = spring_law<dim>(spring);
  return line;
}
}  // namespace

template <int dim>
Line<dim> read_spring(const std::string& name, const ParameterList& list) {
  return read_stretched<dim>(name, list, false);
}

template <int dim>
Line<dim> read_rope(const std::string& name, const ParameterList& list) {
  return read_stretched<dim>(name, list, true);
}

template <int dim>
Line<dim> read_mooring_line(const std::string& name, const ParameterList& list,
                            const Point<dim>& gravity) {
  Line<dim> line = read_ends<dim>(name, list);
  check_input(
      !gravity.isZero(0),
      "The mooring line \"{}\" hangs under its weight, but \"Fluid/Gravity\" is zero; make it "
      "a \"spring\", or give gravity.",
      name);
  CatenaryParameters catenary;
  catenary.length = list.get<double>("Length");
  catenary.weight = list.get<double>("Weight");
  catenary.stiffness = list.get<double>("Stiffness");
  catenary.on_floor = list.get<bool>("On Floor");
  const Point<dim> up = -gravity.normalized();
  check_input(
      !catenary.on_floor || (line.solids[0].empty() && up.dot(line.ends[1] - line.ends[0]) > 0),
      "The mooring line \"{}\" lies on the floor, so its first end must be in \"space\", and "
      "below its second.",
      name);
  line.law = catenary_law<dim>(catenary, up);
  return line;
}

template ParameterList spring_parameters<2>();
template ParameterList spring_parameters<3>();
template ParameterList rope_parameters<2>();
template ParameterList rope_parameters<3>();
template ParameterList mooring_line_parameters<2>();
template ParameterList mooring_line_parameters<3>();
template Line<2> read_spring<2>(const std::string&, const ParameterList&);
template Line<3> read_spring<3>(const std::string&, const ParameterList&);
template Line<2> read_rope<2>(const std::string&, const ParameterList&);
template Line<3> read_rope<3>(const std::string&, const ParameterList&);
template Line<2> read_mooring_line<2>(const std::string&, const ParameterList&, const Point<2>&);
template Line<3> read_mooring_line<3>(const std::string&, const ParameterList&, const Point<3>&);

}  // namespace lockstep
