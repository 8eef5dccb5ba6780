#include "liquid/liquid_parameters.hpp"

#include <cmath>

#include "base/errors.hpp"
#include "geometry/mesh_files.hpp"
#include "geometry/mesh_repair.hpp"
#include "geometry/surface_check.hpp"
#include "geometry/surface_snapshot.hpp"
#include "liquid/watch/watch.hpp"
#include "parameters/field_formula.hpp"
#include "parameters/mistakes.hpp"
#include "staggered/domain/parameter_values.hpp"
#include "staggered/domain/region_shape.hpp"

namespace lockstep {

namespace {
constexpr double very_far = 1e9;  ///< [m], from the liquid of a tank that is empty

/// Below a height, which may depend on the place; then the distance is that to the first order.
template <int dim>
SignedDistance<dim> level(const std::string& name, const ParameterList& list,
                          const Point<dim>& gravity) {
  check_input(
      gravity.norm() > 0,
      "In \"Free Surface\", \"{}\" is a level, but \"Gravity\" is 0, so that nothing says where up "
      "is; give a box, or gravity.",
      name);
  const Point<dim> up = -gravity.normalized();
  const FieldFormula<dim> height(list, "Height", "Fluid/Free Surface/" + name);
  return [up, height](const Point<dim>& x) {
    const double above = x.dot(up) - height(0, x, 0);
    if (height.is_number(0))
      return above;
    const double step = 6e-6 * (1 + x.norm());  // at which a central difference errs least
    Point<dim> slope = up;
    for (int a = 0; a < dim; ++a) {
      const Point<dim> shift = step * Point<dim>::Unit(a);
      slope[a] -= (height(0, x + shift, 0) - height(0, x - shift, 0)) / (2 * step);
    }
    const double length = slope.norm();
    return length > 0 ? above / length : above;
  };
}

template <int dim>
SignedDistance<dim> box(const std::string& name, const ParameterList& list) {
  RegionShape<dim> shape;
  shape.lower = point_value<dim>(list, "Lower");
  shape.upper = point_value<dim>(list, "Upper");
  check_input(
      (shape.upper - shape.lower).minCoeff() > 0,
      "In \"Free Surface\", the box \"{}\" is empty: \"Upper\" must be above \"Lower\" along every "
      "axis.",
      name);
  return [shape](const Point<dim>& x) { return shape.distance(x); };
}

template <int dim>
SignedDistance<dim> ball(const ParameterList& list) {
  const Point<dim> center = point_value<dim>(list, "Center");
  const double radius = list.get<double>("Radius");
  return [=](const Point<dim>& x) { return (x - center).norm() - radius; };
}

/// The distance from a closed mesh, negative inside.
template <int dim>
SignedDistance<dim> mesh(const std::string& name, const ParameterList& list) {
  MeshNames names;
  SurfaceMesh<dim> surface = read_surface<dim>(list.get<std::string>("File"), names);
  repair_surface(list, surface, names);
  check_surface(surface, {name, true, false}, names);
  const Point<dim> position = point_value<dim>(list, "Position");
  for (Point<dim>& vertex : surface.vertices)
    vertex += position;
  SolidDescription whole;
  whole.name = name;
  whole.simplex_end = static_cast<int>(surface.simplices.size());
  whole.vertex_end = static_cast<int>(surface.vertices.size());
  const auto snapshot =
      std::make_shared<const SurfaceSnapshot<dim>>(std::move(surface), std::vector{whole});
  return [snapshot](const Point<dim>& x) {
    const double distance = snapshot->closest_on_solid(x, 0).fraction;
    return snapshot->inside(x) < 0 ? distance : -distance;
  };
}

template <int dim>
std::vector<TypedSchema> liquid_schemas() {
  ParameterList level, box, ball, mesh;
  declare(level, "Height", 0.0,
          "Of the surface, measured against gravity from the origin [m]; with waves a formula of "
          "the place [m], such as \"[0.5 + 0.1*cos(3*x)]\".");
  set_variables(level, "Height", place<dim>());
  declare_vector(box, "Lower", filled_array(dim, 0.0), dim, "Lower corner [m].");
  declare_vector(box, "Upper", filled_array(dim, 1.0), dim, "Upper corner [m].");
  declare_vector(ball, "Center", filled_array(dim, 0.0), dim, "Centre [m].");
  declare_positive(ball, "Radius", 0.1, "Radius [m].");
  declare_required<std::string>(
      mesh, "File",
      "Closed surface: .obj, .off or (3D) .stl; relative to the folder of the scene.");
  declare_mesh_repair(mesh);
  declare_vector(mesh, "Position", filled_array(dim, 0.0), dim,
                 "Position of the origin of the file's coordinates [m].");
  return {{"level", "All below a height.", level},
          {"box", "A box along the axes.", box},
          {"ball", "A ball (2D: a disc).", ball},
          {"mesh", "The inside of a closed mesh of a file.", mesh}};
}

void declare_trapped_air(ParameterList& list) {
  declare_choice(list, "Trapped Air", "massless", {"massless", "ideal gas", "constant volume"},
                 "Content of closed air bubbles above the liquid: \"void\", p = 0, as in the "
                 "atmosphere; \"ideal gas\", whose pressure follows from its volume; \"constant "
                 "volume\", a gas that cannot be compressed. Of more than 8 bubbles the largest "
                 "have gas. Bubbles of at most \"Smallest Cavity\" cells are filled all the same.");
  declare_optional<ParameterArray<double>>(
      list, "Atmosphere",
      "Points, a component an axis, one after the other [m]: air that can be reached from them or "
      "from an open side is no bubble. Absent: nor is air at the side of the domain that "
      "gravity points away from.");
  declare_positive(list, "Atmospheric Pressure", 101325.0,
                   "Pressure of the atmosphere for an ideal gas [Pa].");
  declare_positive(list, "Gas Exponent", 1.4,
                   "gamma of an ideal gas, p V^gamma = const.: 1.4 for air without, 1 with time to "
                   "take the liquid's temperature [1].");
  declare(list, "Gas Pressure", 0.0,
          "Gas pressure in bubbles at the start, above that of the atmosphere [Pa]; for a gas of "
          "constant volume a guess.");
}
}  // namespace

template <int dim>
void declare_free_surface(const InterfaceRegistry<dim>& interfaces, ParameterList& fluid) {
  ParameterList& list =
      declare_optional_list(fluid, "Free Surface",
                            "The fluid is a liquid with a free surface, above which is air at p = "
                            "0. Absent: the fluid fills the domain.");
  const std::string usual = "particle level set";
  declare_typed_sublist(list, "Interface", "Representation and advection of the free surface.",
                        interfaces.schemas(),
                        interfaces.contains(usual) ? usual : interfaces.begin()->name);
  declare_named_sublists(list, "Liquid",
                         "Shapes of the liquid at the start: their union, outside of solids.",
                         liquid_schemas<dim>());
  declare_named_sublists(list, "Bubbles",
                         "Shapes of air or gas within the liquid at the start: their union is no "
                         "liquid.",
                         liquid_schemas<dim>());
  declare_optional<ParameterArray<double>>(
      list, "Dry Points",
      "Points below the surface, a component an axis, one after the other [m]: what can be reached "
      "from them without passing through a solid is dry at the start, as the inside of a boat.");
  ParameterList sink;
  declare_shape<dim>(sink);
  declare_named_sublists(list, "Sinks",
                         "Boxes and balls that take the liquid away that is in them; "
                         "\"Fluid/Sources\" bring it.",
                         sink);
  declare_watches<dim>(list);
  declare_at_least(list, "Surface Tension", 0.0, 0.0,
                   "sigma [N/m] (2D: [N]): the pressure jumps by sigma times the curvature; the "
                   "surface comes to "
                   "meet the walls of the domain at their \"Contact Angle\", and goes on straight "
                   "into solids. 0: "
                   "none.");
  declare_choice(
      list, "Time Integration", "semi-implicit", {"semi-implicit", "explicit"},
      "Of surface tension. explicit: steps are at most 0.28 sqrt(density h^3 / sigma). "
      "semi-implicit: 8 times that; "
      "what the surface does within the step is foreseen by a viscous solve in which sigma dt "
      "times the surface Laplacian holds the velocity back, and one more pressure solve before "
      "it. Damps what turns and swings, the more the longer the step.");
  declare_trapped_air(list);
  declare_between(list, "Pressure Order", 2, 1, 2,
                  "2: p = 0 where the surface is. 1: at the centre of the first cell above it, to "
                  "show what that costs: waves lower than half a cell do not exist then.");
}

FreeSurfaceParameters read_free_surface(const ParameterList& list) {
  return {list.get<int>("Pressure Order"), list.get<double>("Surface Tension"),
          list.get<std::string>("Time Integration") == "semi-implicit"};
}

void declare_phases(ParameterList& fluid) {
  ParameterList& phases = declare_optional_list(
      fluid, "Phases",
      "Two incompressible fluids, one below and one above the surface of \"Free Surface\", with "
      "pressure, momentum and solids in both. Absent: \"Density\" and \"Viscosity\" are those of "
      "the one fluid, and air above a free surface has no mass.");
  ParameterList& liquid = declare_optional_list(
      phases, "Liquid",
      "The fluid below the surface. Absent: it has the fluid's \"Density\" and \"Viscosity\".");
  ParameterList& gas = declare_list(phases, "Gas", "The fluid above the surface.");
  declare_positive(liquid, "Density", 1000.0, "Density [kg/m^3] (2D: [kg/m^2]).");
  declare_positive(gas, "Density", 1.2,
                   "Density [kg/m^3] (2D: [kg/m^2]), no more than the liquid's.");
  for (ParameterList* phase : {&liquid, &gas})
    declare_at_least(*phase, "Viscosity", 0.0, 0.0, "Dynamic viscosity mu [Pa s].");
  declare_choice(
      phases, "Interface Transport", "consistent", {"consistent", "plain"},
      "Of velocities within two cells of the surface. consistent: mass and momentum "
      "go by one flux, so that a heavy drop flies on. plain: as anywhere else, which lets "
      "light gas push heavy liquid, to show what that costs.");
}

Phases read_phases(const ParameterList& fluid) {
  const auto read = [](const ParameterList& phase) {
    return Phase{phase.get<double>("Density"), phase.get<double>("Viscosity")};
  };
  if (!fluid.isSublist("Phases"))
    return {read(fluid), {}};
  const ParameterList& list = fluid.sublist("Phases");
  const bool has_liquid = list.isSublist("Liquid");
  const Phases phases{read(has_liquid ? list.sublist("Liquid") : fluid), read(list.sublist("Gas")),
                      list.get<std::string>("Interface Transport") == "consistent"};
  check_input(fluid.isSublist("Free Surface"),
              "\"Fluid\" has \"Phases\", but nothing says where each of them is; add the list "
              "\"Free Surface\" with its \"Liquid\".");
  check_input(phases.gas->density <= phases.liquid.density,
              "In \"Phases\", \"Gas\" has a density of {:g}, more than \"Liquid\" with {:g}. The "
              "surface moves with the liquid, so that must be the denser one: swap them, and give "
              "the place of the other in \"Free Surface\".",
              phases.gas->density, phases.liquid.density);
  for (const char* name : {"Density", "Viscosity"})
    check_input(!has_liquid || fluid.getEntry(name).isDefault(),
                "\"Fluid\" has \"Phases\" with a \"Liquid\" and a \"{}\" of its own; leave one of "
                "them out, each phase has one.",
                name);
  check_input(!fluid.isSublist("Moving Tiles"),
              "\"Phases\" has a gas, but with \"Moving Tiles\" most of it would have no cells; "
              "leave them out.");
  check_input(fluid.sublist("Free Surface").get<std::string>("Trapped Air") == "massless",
              "\"Phases\" has a gas, which resists by itself where it is closed in; leave out "
              "\"Trapped Air\".");
  return phases;
}

namespace {
template <int dim>
std::vector<SignedDistance<dim>> read_shapes(const ParameterList& list, const std::string& kind,
                                             const Point<dim>& gravity) {
  const ParameterList& shapes = list.sublist(kind);
  std::vector<SignedDistance<dim>> parts;
  Mistakes mistakes;
  for (auto it = shapes.begin(); it != shapes.end(); ++it) {
    const std::string name = kind + "/" + shapes.name(it);
    const ParameterList& shape = shapes.sublist(shapes.name(it));
    const auto type = shape.get<std::string>("Type");
    mistakes.collect([&] {
      parts.push_back(type == "level"  ? level<dim>(name, shape, gravity)
                      : type == "box"  ? box<dim>(name, shape)
                      : type == "mesh" ? mesh<dim>(name, shape)
                                       : ball<dim>(shape));
    });
  }
  mistakes.throw_all();
  return parts;
}

/// Distance from the union of shapes.
template <int dim>
double nearest_of(const std::vector<SignedDistance<dim>>& parts, const Point<dim>& x) {
  double nearest = very_far;
  for (const SignedDistance<dim>& part : parts)
    nearest = std::min(nearest, part(x));
  return nearest;
}
}  // namespace

template <int dim>
SignedDistance<dim> read_liquid(const ParameterList& fluid, const Point<dim>& gravity) {
  const ParameterList& list = fluid.sublist("Free Surface");
  std::vector<SignedDistance<dim>> parts, bubbles;
  Mistakes mistakes;
  mistakes.collect([&] { parts = read_shapes<dim>(list, "Liquid", gravity); });
  mistakes.collect([&] { bubbles = read_shapes<dim>(list, "Bubbles", gravity); });
  mistakes.throw_all();
  const ParameterList& sources = fluid.sublist("Sources");
  bool has_source = false;
  for (auto it = sources.begin(); it != sources.end(); ++it)
    has_source = has_source || sources.sublist(sources.name(it)).get<bool>("Liquid");
  check_input(
      !parts.empty() || has_source,
      "\"Free Surface\" has no liquid; say where it is in the list \"Liquid\", or have one of "
      "\"Fluid/Sources\" bring it.");
  return [parts = std::move(parts), bubbles = std::move(bubbles)](const Point<dim>& x) {
    return std::max(nearest_of<dim>(parts, x), -nearest_of<dim>(bubbles, x));
  };
}

namespace {
/// Reads the points of an optional array, the components of one after the other.
template <int dim>
std::vector<Point<dim>> read_points(const ParameterList& list, const char* name) {
  if (!list.isParameter(name))
    return {};
  const auto& numbers = list.get<ParameterArray<double>>(name);
  check_input(numbers.size() % dim == 0,
              "In \"Free Surface\", \"{}\" has {} numbers; it takes {} a point.", name,
              numbers.size(), dim);
  std::vector<Point<dim>> points(numbers.size() / dim);
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int a = 0; a < dim; ++a)
      points[p][a] = numbers[p * dim + a];
  return points;
}
}  // namespace

template <int dim>
std::vector<Point<dim>> read_dry_points(const ParameterList& list) {
  return read_points<dim>(list, "Dry Points");
}

template <int dim>
GasParameters<dim> read_gas(const ParameterList& fluid) {
  const ParameterList& list = fluid.sublist("Free Surface");
  const auto kind = list.get<std::string>("Trapped Air");
  GasParameters<dim> gas;
  if (kind == "massless")
    return gas;
  check_input(!fluid.isSublist("Moving Tiles"),
              "\"Trapped Air\" is \"{}\", but with \"Moving Tiles\" not all of the air is there "
              "to be looked through; leave them out.",
              kind);
  gas.kind = kind == "ideal gas" ? TrappedAir::ideal_gas : TrappedAir::constant_volume;
  gas.atmospheric_pressure = list.get<double>("Atmospheric Pressure");
  gas.exponent = list.get<double>("Gas Exponent");
  gas.pressure_at_start = list.get<double>("Gas Pressure");
  check_input(gas.pressure_at_start > -gas.atmospheric_pressure,
              "In \"Free Surface\", \"Gas Pressure\" is measured from the atmosphere's and must be "
              "above minus \"Atmospheric Pressure\", {:g} Pa.",
              -gas.atmospheric_pressure);
  gas.atmosphere = read_points<dim>(list, "Atmosphere");
  return gas;
}

template <int dim>
std::vector<SignedDistance<dim>> read_sinks(const ParameterList& list) {
  const ParameterList& sinks = list.sublist("Sinks");
  std::vector<SignedDistance<dim>> shapes;
  Mistakes mistakes;
  for (auto it = sinks.begin(); it != sinks.end(); ++it)
    mistakes.collect([&] {
      const auto shape = read_shape<dim>(sinks.sublist(sinks.name(it)));
      shapes.push_back([shape](const Point<dim>& x) { return shape.distance(x); });
    });
  mistakes.throw_all();
  return shapes;
}

template <int dim>
void check_free_surface(const ParameterList& fluid, const Point<dim>& gravity,
                        const std::array<bool, dim>& periodic) {
  for (const char* scalar : {"Smoke", "Temperature"})
    check_input(
        !fluid.isSublist(scalar) || fluid.isSublist("Phases"),
        "\"{}\" and \"Free Surface\" are both given, but below air without mass a liquid "
        "carries no scalars; give the air a mass with \"Phases\", or leave one of them out.",
        scalar);
  check_input(
      fluid.get<int>("Order in Time") != 2,
      "\"Order in Time\" 2 and \"Free Surface\" do not go together: pressures act at the new "
      "surface, which moves with the old velocity, so that waves keep their height; an "
      "advection velocity from the middle of the step would damp them. Leave the order out.");
  for (int axis = 0; axis < dim; ++axis)
    check_input(
        !periodic[axis] ||
            (gravity[axis] == 0 && FieldFormula<dim>(fluid, "Gravity", "Fluid").is_number(axis)),
        "With a \"Free Surface\", gravity may not act along the periodic axis {}: the liquid "
        "would fall for ever.",
        "xyz"[axis]);
}

template void declare_free_surface<2>(const InterfaceRegistry<2>&, ParameterList&);
template void declare_free_surface<3>(const InterfaceRegistry<3>&, ParameterList&);
template GasParameters<2> read_gas<2>(const ParameterList&);
template GasParameters<3> read_gas<3>(const ParameterList&);
template std::vector<Point<2>> read_dry_points<2>(const ParameterList&);
template std::vector<Point<3>> read_dry_points<3>(const ParameterList&);
template std::vector<SignedDistance<2>> read_sinks<2>(const ParameterList&);
template std::vector<SignedDistance<3>> read_sinks<3>(const ParameterList&);
template SignedDistance<2> read_liquid<2>(const ParameterList&, const Point<2>&);
template SignedDistance<3> read_liquid<3>(const ParameterList&, const Point<3>&);
template void check_free_surface<2>(const ParameterList&, const Point<2>&,
                                    const std::array<bool, 2>&);
template void check_free_surface<3>(const ParameterList&, const Point<3>&,
                                    const std::array<bool, 3>&);

}  // namespace lockstep
