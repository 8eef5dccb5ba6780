#include "staggered/domain/region_shape.hpp"

#include <string>
#include <vector>

#include "base/errors.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
void declare_shape(ParameterList& list) {
  std::vector<std::string> shapes = {"box", "ball"};
  if (dim == 3)
    shapes.push_back("cylinder");
  declare_required_choice(list, "Shape", shapes, "The part of space meant.");
  const auto declare_point = [&list](const char* name, const std::string& doc) {
    declare_optional<ParameterArray<double>>(list, name, doc);
    set_length(list, name, dim);
  };
  declare_point("Lower", "Lower corner of the box [m]; default: the origin.");
  declare_point("Upper", "Upper corner of the box [m]; default: 1 m along every axis.");
  const std::string round = dim == 3 ? "ball or cylinder" : "ball";
  declare_point("Center", "Centre of the " + round + " [m]; default: the origin.");
  declare_optional<double>(list, "Radius", "Radius of the " + round + " [m]; default 0.1.");
  set_positive(list, "Radius");
  if (dim == 2)
    return;
  declare_point("Axis", "Direction of the cylinder's axis, of any length; default: y.");
  declare_optional<double>(list, "Length", "Length of the cylinder [m]; default 1.");
  set_positive(list, "Length");
}

namespace {
/// "Sources/Jet": Teuchos has the names of all lists around it, "Scene->Fluid->Sources->Jet".
std::string short_path(const ParameterList& list) {
  const std::string& path = list.name();
  const std::size_t last = path.rfind("->");
  if (last == std::string::npos)
    return path;
  const std::size_t before = path.rfind("->", last - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 2;
  return path.substr(begin, last - begin) + "/" + path.substr(last + 2);
}
}  // namespace

template <int dim>
RegionShape<dim> read_shape(const ParameterList& list) {
  RegionShape<dim> shape;
  using Kind = typename RegionShape<dim>::Kind;
  const std::string& name = list.get<std::string>("Shape");
  shape.kind = name == "ball" ? Kind::ball : name == "cylinder" ? Kind::cylinder : Kind::box;
  for (const std::string size : {"Lower", "Upper", "Center", "Radius", "Axis", "Length"}) {
    const bool of_box = size == "Lower" || size == "Upper";
    const bool of_cylinder = size == "Axis" || size == "Length";
    const bool fits = of_box        ? shape.kind == Kind::box
                      : of_cylinder ? shape.kind == Kind::cylinder
                                    : shape.kind != Kind::box;
    check_input(!list.isParameter(size) || fits,
                "In \"{}\", the shape \"{}\" has no \"{}\"; leave it out.", short_path(list), name,
                size);
  }
  const auto point = [&list](const char* size, double otherwise) {
    return list.isParameter(size) ? point_value<dim>(list, size)
                                  : Point<dim>(Point<dim>::Constant(otherwise));
  };
  shape.lower = point("Lower", 0);
  shape.upper = point("Upper", 1);
  check_input((shape.upper - shape.lower).minCoeff() >= 0,
              "In \"{}\", the box is empty: \"Upper\" must not be below \"Lower\" along any axis.",
              short_path(list));
  shape.center = point("Center", 0);
  shape.radius = list.isParameter("Radius") ? list.get<double>("Radius") : 0.1;
  shape.length = list.isParameter("Length") ? list.get<double>("Length") : 1;
  shape.axis = list.isParameter("Axis") ? point_value<dim>(list, "Axis") : Point<dim>::Unit(1);
  check_input(shape.axis.norm() > 0, "In \"{}\", the \"Axis\" is zero; it needs a direction.",
              short_path(list));
  shape.axis.normalize();
  return shape;
}

template void declare_shape<2>(ParameterList&);
template void declare_shape<3>(ParameterList&);
template RegionShape<2> read_shape<2>(const ParameterList&);
template RegionShape<3> read_shape<3>(const ParameterList&);

}  // namespace lockstep
