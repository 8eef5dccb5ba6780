#include "mac/domain/region_shape.hpp"

#include "mac/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
void declare_shape(ParameterList& list) {
  declare_required_choice(list, "Shape", {"box", "ball"}, "The part of space meant.");
  declare_vector(list, "Lower", filled_array(dim, 0.0), dim, "Lower corner of the box [m].");
  declare_vector(list, "Upper", filled_array(dim, 1.0), dim, "Upper corner of the box [m].");
  declare_vector(list, "Center", filled_array(dim, 0.0), dim, "Centre of the ball [m].");
  declare_positive(list, "Radius", 0.1, "Radius of the ball [m].");
}

template <int dim>
RegionShape<dim> read_shape(const ParameterList& list) {
  RegionShape<dim> shape;
  shape.ball = list.get<std::string>("Shape") == "ball";
  shape.lower = point_value<dim>(list, "Lower");
  shape.upper = point_value<dim>(list, "Upper");
  shape.center = point_value<dim>(list, "Center");
  shape.radius = list.get<double>("Radius");
  return shape;
}

template void declare_shape<2>(ParameterList&);
template void declare_shape<3>(ParameterList&);
template RegionShape<2> read_shape<2>(const ParameterList&);
template RegionShape<3> read_shape<3>(const ParameterList&);

}  // namespace lockstep
