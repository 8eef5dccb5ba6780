#include "staggered/domain/inflow_scalars.hpp"

#include "base/errors.hpp"
#include "parameters/formula.hpp"

namespace lockstep {

template <int dim>
void declare_inflow_scalars(ParameterList& side) {
  declare_optional<double>(side, "Smoke",
                           "Smoke density that an inflow carries [1], or a formula of place [m] "
                           "and time [s]; default: the ambient one.");
  declare_optional<double>(side, "Temperature",
                           "Temperature that an inflow carries [K], or a formula of place [m] and "
                           "time [s]; default: the ambient one.");
  for (const char* name : {"Smoke", "Temperature"})
    set_variables(side, name, place_and_time(dim));
}

template <int dim>
void read_inflow_scalars(const ParameterList& fluid, const ParameterList& domain,
                         Boundary<dim>& boundary) {
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      BoundarySide<dim>& side = boundary.sides[axis][end];
      const std::string name = side_name(axis, end);
      const ParameterList& list = domain.sublist("Sides").sublist(name);
      const auto carried = [&](const std::string& scalar) {
        const bool in_fluid = fluid.isSublist(scalar);
        if (!list.isParameter(scalar))
          return FieldFormula<dim>(
              std::vector<double>{in_fluid ? fluid.sublist(scalar).get<double>("Ambient") : 0.});
        check_input(side.type == SideType::inflow,
                    "In \"Domain/Sides/{}\", \"{}\" has no meaning on a side of type \"{}\"; it is "
                    "for inflows.",
                    name, scalar, list.get<std::string>("Type"));
        check_input(in_fluid,
                    "In \"Domain/Sides/{}\", the inflow has a \"{}\", but the fluid carries none; "
                    "add the list \"Fluid/{}\", or leave it out.",
                    name, scalar, scalar);
        return FieldFormula<dim>(list, scalar, "Domain/Sides/" + name);
      };
      side.smoke = carried("Smoke");
      side.temperature = carried("Temperature");
    }
}

template void declare_inflow_scalars<2>(ParameterList&);
template void declare_inflow_scalars<3>(ParameterList&);
template void read_inflow_scalars<2>(const ParameterList&, const ParameterList&, Boundary<2>&);
template void read_inflow_scalars<3>(const ParameterList&, const ParameterList&, Boundary<3>&);

}  // namespace lockstep
