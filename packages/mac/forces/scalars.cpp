#include "mac/forces/scalars.hpp"

#include "base/errors.hpp"
#include "mac/forces/scalar_mistakes.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {
template <int dim>
void declare_scalar(ParameterList& fluid, const std::string& name, const std::string& unit,
                    const std::string& doc) {
  ParameterList& list = declare_optional_list(fluid, name, doc);
  declare(list, "Ambient", 0.0,
          "Value far away, and at the start unless others say more, " + unit + ".");
  declare_optional<double>(list, "Value",
                           "Value at the start outside all \"Regions\", " + unit +
                               ", such as the formula \"[300 + 5*y]\"; default: \"Ambient\".");
  set_variables(list, "Value", place<dim>());
  ParameterList region;
  declare_shape<dim>(region);
  declare(region, "Value", 1.0, "Value inside at the start, " + unit + ".");
  set_variables(region, "Value", place<dim>());
  declare_named_sublists(list, "Regions", "Boxes and balls with another initial value.", region);
}

template <int dim>
Scalar read_scalar(const MacDomain<dim>& domain, const ParameterList& list, const std::string& name,
                   const std::string& unit) {
  Scalar scalar;
  scalar.name = name;
  scalar.unit = unit;
  scalar.ambient = list.get<double>("Ambient");
  scalar.values.assign(domain.grid.n_stored_cells(), scalar.ambient);
  const std::string where = name == "smoke" ? "Fluid/Smoke" : "Fluid/Temperature";
  if (list.isParameter("Value")) {
    const FieldFormula<dim> value(list, "Value", where);
    domain.grid.for_each_stored_cell(
        [&](int cell) { scalar.values[cell] = value(0, domain.grid.center(cell), 0); });
  }
  const ParameterList& regions = list.sublist("Regions");
  for (auto it = regions.begin(); it != regions.end(); ++it) {
    const ParameterList& region = regions.sublist(regions.name(it));
    const RegionShape<dim> shape = read_shape<dim>(region);
    const FieldFormula<dim> value(region, "Value", where + "/Regions/" + regions.name(it));
    domain.grid.for_each_stored_cell([&](int cell) {
      const Point<dim> x = domain.grid.center(cell);
      if (shape.contains(x))
        scalar.values[cell] = value(0, x, 0);
    });
  }
  return scalar;
}

template <int dim>
ScalarSource<dim> read_source(const ParameterList& list) {
  ScalarSource<dim> source;
  source.shape = read_shape<dim>(list);
  source.begin_time = list.get<double>("Start");
  if (list.isParameter("End"))
    source.end_time = list.get<double>("End");
  if (list.isParameter("Smoke"))
    source.feeds.push_back({"smoke", list.get<double>("Smoke")});
  if (list.isParameter("Temperature"))
    source.feeds.push_back({"temperature", list.get<double>("Temperature")});
  source.liquid = list.get<bool>("Liquid");
  if (list.isParameter("Velocity"))
    source.velocity = point_value<dim>(list, "Velocity");
  return source;
}

/// Throws InputError for a source outside of the domain or of what the fluid does not carry.
template <int dim>
void check_source(const ScalarSource<dim>& source, const std::string& name,
                  const ParameterList& fluid, const Box<dim>& bounds) {
  check_input(bounds.intersects(source.shape.bounds()),
              "The source \"{}\" in \"Fluid/Sources\" lies outside of the domain and feeds "
              "nothing; move it inside.",
              name);
  check_input(!source.liquid || fluid.isSublist("Free Surface"),
              "The source \"{}\" in \"Fluid/Sources\" feeds liquid, but the fluid fills its domain "
              "already; add the list \"Fluid/Free Surface\".",
              name);
  for (const auto& feed : source.feeds) {
    const char* const list = feed.scalar == "smoke" ? "Smoke" : "Temperature";
    check_input(fluid.isSublist(list),
                "The source \"{}\" in \"Fluid/Sources\" feeds {}, but the fluid carries none; add "
                "the list \"Fluid/{}\".",
                name, feed.scalar, list);
  }
}
}  // namespace

template <int dim>
void declare_scalars(ParameterList& fluid) {
  declare_scalar<dim>(fluid, "Smoke", "[1]",
                      "Density of smoke, which the fluid carries. Absent: none.");
  declare_scalar<dim>(fluid, "Temperature", "[K]",
                      "Temperature, which the fluid carries. Absent: none.");
  ParameterList source;
  declare_shape<dim>(source);
  declare_optional<double>(source, "Smoke", "Smoke density held inside [1].");
  declare_optional<double>(source, "Temperature", "Temperature held inside [K].");
  declare_optional<ParameterArray<double>>(
      source, "Velocity", "Velocity given to the fluid inside at every step [m/s].");
  set_length(source, "Velocity", dim);
  declare(source, "Start", 0.0, "When the source starts [s].");
  declare_optional<double>(source, "End", "When it stops [s]; never if it is left out.");
  declare(
      source, "Liquid", false,
      "Fill it with liquid at every step, which its velocity carries away: a jet. For fluids with "
      "a \"Free Surface\".");
  declare_named_sublists(fluid, "Sources",
                         "Boxes and balls that feed liquid, smoke, heat and momentum.", source);
}

template <int dim>
Scalars<dim>::Scalars(const MacDomain<dim>& domain, const ParameterList& fluid) : domain_(domain) {
  if (fluid.isSublist("Smoke"))
    scalars_.push_back(read_scalar(domain, fluid.sublist("Smoke"), "smoke", "1"));
  if (fluid.isSublist("Temperature"))
    scalars_.push_back(read_scalar(domain, fluid.sublist("Temperature"), "temperature", "K"));
  const ParameterList& sources = fluid.sublist("Sources");
  for (auto it = sources.begin(); it != sources.end(); ++it) {
    sources_.push_back(read_source<dim>(sources.sublist(sources.name(it))));
    check_source(sources_.back(), sources.name(it), fluid, domain.bounds());
  }
}

template <int dim>
void find_scalar_mistakes(const ParameterList& fluid, const Box<dim>& bounds, Mistakes& mistakes) {
  for (const char* scalar : {"Smoke", "Temperature"}) {
    if (!fluid.isSublist(scalar))
      continue;
    const ParameterList& regions = fluid.sublist(scalar).sublist("Regions");
    for (auto it = regions.begin(); it != regions.end(); ++it)
      mistakes.collect([&] { read_shape<dim>(regions.sublist(regions.name(it))); });
  }
  const ParameterList& sources = fluid.sublist("Sources");
  for (auto it = sources.begin(); it != sources.end(); ++it)
    mistakes.collect([&] {
      const auto source = read_source<dim>(sources.sublist(sources.name(it)));
      check_source(source, sources.name(it), fluid, bounds);
    });
}

template <int dim>
const Scalar* Scalars<dim>::find(const std::string& name) const {
  for (const Scalar& scalar : scalars_)
    if (scalar.name == name)
      return &scalar;
  return nullptr;
}

template <int dim>
void Scalars<dim>::feed(const MacGeometry<dim>& geometry, double time) {
  const TiledGrid<dim>& grid = domain_.grid;
  for (const ScalarSource<dim>& source : sources_) {
    if (!source.active(time) || source.feeds.empty())
      continue;
    grid.for_each_owned_cell([&](int cell) {
      if (geometry.state.cells[cell] != CellState::fluid ||
          !source.shape.contains(grid.center(cell)))
        return;
      for (const auto& feed : source.feeds)
        for (Scalar& scalar : scalars_)
          if (scalar.name == feed.scalar)
            scalar.values[cell] = feed.value;
    });
  }
}

template <int dim>
std::vector<std::function<double(const Point<dim>&)>> Scalars<dim>::liquid_sources(
    double time) const {
  std::vector<std::function<double(const Point<dim>&)>> shapes;
  for (const ScalarSource<dim>& source : sources_)
    if (source.liquid && source.active(time))
      shapes.push_back([shape = source.shape](const Point<dim>& x) { return shape.distance(x); });
  return shapes;
}

template <int dim>
bool Scalars<dim>::sources_push(double time) const {
  for (const ScalarSource<dim>& source : sources_)
    if (source.velocity && source.active(time))
      return true;
  return false;
}

template <int dim>
bool Scalars<dim>::begin_to_push(double earlier, double now) const {
  for (const ScalarSource<dim>& source : sources_)
    if (source.velocity && source.active(now) && !source.active(earlier))
      return true;
  return false;
}

template <int dim>
void Scalars<dim>::push(const MacGeometry<dim>& geometry, double time,
                        FaceField<dim>& velocity) const {
  const TiledGrid<dim>& grid = domain_.grid;
  for (const ScalarSource<dim>& source : sources_)
    for (int axis = 0; source.velocity && source.active(time) && axis < dim; ++axis)
      grid.for_each_owned_face(axis, [&](int cell) {
        if (geometry.state.faces[axis][cell] == FaceState::free &&
            source.shape.contains(grid.face_center(axis, cell)))
          velocity[axis][cell] = (*source.velocity)[axis];
      });
}

template class Scalars<2>;
template class Scalars<3>;
template void find_scalar_mistakes(const ParameterList&, const Box<2>&, Mistakes&);
template void find_scalar_mistakes(const ParameterList&, const Box<3>&, Mistakes&);
template void declare_scalars<2>(ParameterList&);
template void declare_scalars<3>(ParameterList&);

}  // namespace lockstep
