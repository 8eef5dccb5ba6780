#include "mac/domain/region_shape.hpp"

#include "base/errors.hpp"
#include "mac/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
void declare_shape(ParameterList& list) {
  declare_required_choice(list, "Shape", {"box", "ball"}, "The part of space meant.");
  const auto declare_point = [&list](const char* name, const std::string& doc) {
    declare_optional<ParameterArray<double>>(list, name, doc);
    set_length(list, name, dim);
  };
  declare_point("Lower", "Lower corner of the box [m]; default: the origin.");
  declare_point("Upper", "Upper corner of the box [m]; default: 1 m along every axis.");
  declare_point("Center", "Centre of the ball [m]; default: the origin.");
  declare_optional<double>(list, "Radius", "Radius of the ball [m]; default 0.1.");
  set_positive(list, "Radius");
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
  shape.ball = list.get<std::string>("Shape") == "ball";
  for (const std::string size : {"Lower", "Upper", "Center", "Radius"}) {
    const bool of_ball = size == "Center" || size == "Radius";
    check_input(!list.isParameter(size) || shape.ball == of_ball,
                "In \"{}\", the shape \"{}\" has no \"{}\"; leave it out.", short_path(list),
                list.get<std::string>("Shape"), size);
  }
  const auto point = [&list](const char* name, double otherwise) {
    return list.isParameter(name) ? point_value<dim>(list, name)
                                  : Point<dim>(Point<dim>::Constant(otherwise));
  };
  shape.lower = point("Lower", 0);
  shape.upper = point("Upper", 1);
  check_input((shape.upper - shape.lower).minCoeff() >= 0,
              "In \"{}\", the box is empty: \"Upper\" must not be below \"Lower\" along any axis.",
              short_path(list));
  shape.center = point("Center", 0);
  shape.radius = list.isParameter("Radius") ? list.get<double>("Radius") : 0.1;
  return shape;
}

template void declare_shape<2>(ParameterList&);
template void declare_shape<3>(ParameterList&);
template RegionShape<2> read_shape<2>(const ParameterList&);
template RegionShape<3> read_shape<3>(const ParameterList&);

}  // namespace lockstep
