#include "mac/state/mac_parameters.hpp"

#include <map>

#include "mac/tiles/moving_tiles.hpp"
#include "parameters/formula.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {
const std::map<std::string, AdvectionScheme>& advection_schemes() {
  static const std::map<std::string, AdvectionScheme> schemes{
      {"semi-lagrangian", AdvectionScheme::semi_lagrangian},
      {"maccormack", AdvectionScheme::maccormack},
      {"cubic", AdvectionScheme::cubic}};
  return schemes;
}
}  // namespace

template <int dim>
ParameterList mac_parameters(const InterfaceRegistry<dim>* interfaces) {
  ParameterList list("Fluid");
  declare_positive(list, "Density", 1000.0, "Density [kg/m^3] (2D: [kg/m^2]).");
  declare_at_least(list, "Viscosity", 0.0, 0.0,
                   "Dynamic viscosity mu [Pa s]. 0: no viscous solve at all.");
  if (interfaces)
    declare_phases(list);
  declare_between(list, "Smallest Link", 0.2, 0.01, 1.0,
                  "Viscous links that end on a surface are not taken shorter than this part of a "
                  "cell [1]; shorter ones would make the viscous solve stiff.");
  declare_vector(list, "Velocity", filled_array(dim, 0.0), dim,
                 dim == 2 ? "Velocity at the start [m/s]; formulas of the place x, y [m], such as "
                            "\"[sin(3*x)*cos(3*y)]\". What of it has a divergence goes with the "
                            "first step."
                          : "Velocity at the start [m/s]; formulas of the place x, y, z [m], such "
                            "as \"[sin(3*x)*cos(3*y)]\". What of it has a divergence goes with "
                            "the first step.");
  set_variables(list, "Velocity", place<dim>());
  declare_vector(
      list, "Gravity", filled_array(dim, 0.0), dim,
      "Acceleration of gravity, on fluid and solids [m/s^2]; in a tank that moves formulas "
      "of the time t [s], such as \"{[0.5*sin(3*t)], -9.81}\". Where up is, a level and "
      "the side of the atmosphere ask of that at t = 0.");
  set_variables(list, "Gravity", {"t"});
  declare_vector(list, "Body Force", filled_array(dim, 0.0), dim,
                 "Uniform acceleration of the fluid alone, besides gravity [m/s^2].");
  declare(
      list, "Damping", 0.0,
      "Rate at which the velocity decays [1/s], or a formula of the place [m] and the time [s]: "
      "a beach that takes up waves, \"[8*max((x - 4)/2, 0)^2]\".");
  set_at_least(list, "Damping", 0);
  set_variables(list, "Damping", place_and_time(dim));
  std::vector<std::string> schemes;
  for (const auto& [name, scheme] : advection_schemes())
    schemes.push_back(name);
  declare_choice(
      list, "Advection", "maccormack", schemes,
      "semi-lagrangian: first order, damps; maccormack: second order where smooth, "
      "clamped to the values around, with an error taken off that is smoothed, so that "
      "what the grid does not resolve gains no energy; cubic: semi-lagrangian with cubic "
      "interpolation, third order, damps least, within the range of the 4 samples around "
      "along each axis. Any step is stable with all; near surfaces all are "
      "semi-lagrangian.");
  declare_between(
      list, "Order in Time", 0, 0, 2,
      "Of advection and all else together. 1: as in the paper, advection knows nothing of pressure "
      "and forces. 2: what they did in the last step is averaged along the rays (trapezoidal rule) "
      "and the advection velocity is taken in the middle of the step; with maccormack, errors fall "
      "with h^2 where the flow is smooth, at the cost of memory for 4 velocity fields. 0: 2 where "
      "fluid fills its domain, 1 with a free surface, which knows no second order.");
  declare_at_least(
      list, "Thermal Expansion", 0.0, 0.0,
      "Boussinesq coefficient beta: fluid of temperature T feels -beta (T - T0) g, where T0 "
      "is the ambient temperature [1/K].");
  declare(list, "Smoke Weight", 0.0,
          "Relative excess density of fluid with smoke density 1: smoke s feels weight s g [1]; "
          "negative: it rises.");
  declare_scalars<dim>(list);
  if (interfaces)
    declare_free_surface<dim>(*interfaces, list);
  declare_moving_tiles<dim>(list);
  return list;
}

template <int dim>
MacParameters<dim> read_mac_parameters(const ParameterList& fluid) {
  MacParameters<dim> parameters;
  parameters.phases = read_phases(fluid);
  parameters.density = parameters.phases.liquid.density;
  parameters.viscosity.viscosity = parameters.phases.largest_viscosity();
  parameters.viscosity.smallest_coupling_fraction = fluid.get<double>("Smallest Link");
  parameters.viscosity.has_air = fluid.isSublist("Free Surface");
  parameters.forces.gravity_law = FieldFormula<dim>(fluid, "Gravity", "Fluid");
  parameters.forces.gravity = gravity_at_start<dim>(fluid);
  parameters.forces.damping = FieldFormula<dim>(fluid, "Damping", "Fluid");
  parameters.forces.body = point_value<dim>(fluid, "Body Force");
  parameters.forces.expansion = fluid.get<double>("Thermal Expansion");
  if (fluid.isSublist("Temperature"))
    parameters.forces.reference_temperature = fluid.sublist("Temperature").get<double>("Ambient");
  parameters.forces.smoke_weight = fluid.get<double>("Smoke Weight");
  parameters.advection = advection_schemes().at(fluid.get<std::string>("Advection"));
  parameters.order_in_time = fluid.get<int>("Order in Time");
  if (parameters.order_in_time == 0)
    parameters.order_in_time = fluid.isSublist("Free Surface") ? 1 : 2;
  check_input(parameters.forces.expansion == 0 || fluid.isSublist("Temperature"),
              "In \"Fluid\", \"Thermal Expansion\" is {} but the fluid has no temperature; add the "
              "list \"Temperature\".",
              parameters.forces.expansion);
  check_input(parameters.forces.smoke_weight == 0 || fluid.isSublist("Smoke"),
              "In \"Fluid\", \"Smoke Weight\" is {} but the fluid carries no smoke; add the list "
              "\"Smoke\".",
              parameters.forces.smoke_weight);
  return parameters;
}

template ParameterList mac_parameters<2>(const InterfaceRegistry<2>*);
template ParameterList mac_parameters<3>(const InterfaceRegistry<3>*);
template MacParameters<2> read_mac_parameters<2>(const ParameterList&);
template MacParameters<3> read_mac_parameters<3>(const ParameterList&);

}  // namespace lockstep
