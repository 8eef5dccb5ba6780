#include "staggered/domain/inflow_shape.hpp"

#include "base/errors.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
double InflowShape<dim>::factor(int axis, const Point<dim>& x) const {
  double product = 1;
  for (int a = 0; a < dim; ++a) {
    if (a == axis)
      continue;
    if (x[a] < opening.min()[a] || x[a] > opening.max()[a])
      return 0;
    const double s = (x[a] - opening.min()[a]) / opening.sizes()[a];
    product *= parabolic ? 6 * s * (1 - s) : 1;
  }
  return product;
}

namespace {

/// Integral of the profile over a part [from, to] of an opening, in lengths of the opening.
double integral(bool parabolic, double from, double to) {
  const auto primitive = [](double s) { return s * s * (3 - 2 * s); };
  return parabolic ? primitive(to) - primitive(from) : to - from;
}

}  // namespace

template <int dim>
double InflowShape<dim>::mean_factor(int axis, const Box<dim>& face) const {
  constexpr double round_off = 1e-9;
  double product = 1;
  for (int a = 0; a < dim; ++a) {
    if (a == axis)
      continue;
    const double size = face.sizes()[a], length = opening.sizes()[a];
    const double lower = std::max(face.min()[a], opening.min()[a]);
    const double upper = std::min(face.max()[a], opening.max()[a]);
    if (upper - lower <= round_off * size)
      return 0;
    if (parabolic || upper - lower < (1 - round_off) * size)
      product *= integral(parabolic, (lower - opening.min()[a]) / length,
                          (upper - opening.min()[a]) / length) *
                 length / size;
  }
  return product;
}

template <int dim>
void declare_inflow_shape(ParameterList& side) {
  declare_choice(side, "Profile", "uniform", {"uniform", "parabolic"},
                 "Profile of an inflow over its opening; \"Velocity\" is the mean. parabolic: that "
                 "of a channel, along each axis of the side.");
  ParameterList& opening = declare_optional_list(
      side, "Opening",
      "The part of the side that an inflow enters through; the rest is a wall. "
      "Faces of cells that lie in it in part let in their part.");
  for (const char* corner : {"Lower", "Upper"}) {
    declare_required_vector<double>(opening, corner, dim,
                                    "Corner of a box whose section with the side is open [m].");
  }
}

template <int dim>
InflowShape<dim> read_inflow_shape(const ParameterList& side, const Box<dim>& domain, int axis,
                                   const std::string& where) {
  InflowShape<dim> shape;
  shape.parabolic = side.get<std::string>("Profile") == "parabolic";
  shape.opening = domain;
  const bool is_inflow = side.get<std::string>("Type") == "inflow";
  check_input(is_inflow || (!shape.parabolic && !side.isSublist("Opening")),
              "In \"{}\", \"Profile\" and \"Opening\" are for inflows only.", where);
  if (!side.isSublist("Opening"))
    return shape;
  const ParameterList& list = side.sublist("Opening");
  const Box<dim> box(point_value<dim>(list, "Lower"), point_value<dim>(list, "Upper"));
  for (int a = 0; a < dim; ++a) {
    if (a == axis)
      continue;
    shape.opening.min()[a] = std::max(box.min()[a], domain.min()[a]);
    shape.opening.max()[a] = std::min(box.max()[a], domain.max()[a]);
    check_input(shape.opening.min()[a] < shape.opening.max()[a],
                "In \"{}\", \"Opening\" leaves nothing of the side: along {} it reaches from {} to "
                "{} m.",
                where, "xyz"[a], box.min()[a], box.max()[a]);
  }
  return shape;
}

template struct InflowShape<2>;
template struct InflowShape<3>;
template void declare_inflow_shape<2>(ParameterList&);
template void declare_inflow_shape<3>(ParameterList&);
template InflowShape<2> read_inflow_shape<2>(const ParameterList&, const Box<2>&, int,
                                             const std::string&);
template InflowShape<3> read_inflow_shape<3>(const ParameterList&, const Box<3>&, int,
                                             const std::string&);

}  // namespace lockstep
