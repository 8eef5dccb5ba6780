#include "staggered/domain/inflow_opening.hpp"

#include "base/errors.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
bool InflowOpening<dim>::contains(int axis, const Point<dim>& x) const {
  for (int a = 0; a < dim; ++a)
    if (a != axis && (x[a] < box.min()[a] || x[a] > box.max()[a]))
      return false;
  return true;
}

template <int dim>
double InflowOpening<dim>::share(int axis, const Box<dim>& face, Box<dim>& open) const {
  constexpr double round_off = 1e-9;
  double product = 1;
  open = face;
  for (int a = 0; a < dim; ++a) {
    if (a == axis)
      continue;
    const double size = face.sizes()[a];
    const double lower = std::max(face.min()[a], box.min()[a]);
    const double upper = std::min(face.max()[a], box.max()[a]);
    if (upper - lower <= round_off * size)
      return 0;
    if (upper - lower < (1 - round_off) * size) {
      product *= (upper - lower) / size;
      open.min()[a] = lower;
      open.max()[a] = upper;
    }
  }
  return product;
}

template <int dim>
void declare_inflow_opening(ParameterList& side) {
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
InflowOpening<dim> read_inflow_opening(const ParameterList& side, const Box<dim>& domain, int axis,
                                       const std::string& where) {
  InflowOpening<dim> opening;
  opening.box = domain;
  const bool is_inflow = side.get<std::string>("Type") == "inflow";
  check_input(is_inflow || !side.isSublist("Opening"),
              "In \"{}\", \"Opening\" is for inflows only.", where);
  if (!side.isSublist("Opening"))
    return opening;
  const ParameterList& list = side.sublist("Opening");
  const Box<dim> box(point_value<dim>(list, "Lower"), point_value<dim>(list, "Upper"));
  for (int a = 0; a < dim; ++a) {
    if (a == axis)
      continue;
    opening.box.min()[a] = std::max(box.min()[a], domain.min()[a]);
    opening.box.max()[a] = std::min(box.max()[a], domain.max()[a]);
    check_input(opening.box.min()[a] < opening.box.max()[a],
                "In \"{}\", \"Opening\" leaves nothing of the side: along {} it reaches from {} to "
                "{} m.",
                where, "xyz"[a], box.min()[a], box.max()[a]);
  }
  return opening;
}

template struct InflowOpening<2>;
template struct InflowOpening<3>;
template void declare_inflow_opening<2>(ParameterList&);
template void declare_inflow_opening<3>(ParameterList&);
template InflowOpening<2> read_inflow_opening<2>(const ParameterList&, const Box<2>&, int,
                                                 const std::string&);
template InflowOpening<3> read_inflow_opening<3>(const ParameterList&, const Box<3>&, int,
                                                 const std::string&);

}  // namespace lockstep
