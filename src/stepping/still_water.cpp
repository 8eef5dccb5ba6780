#include "stepping/still_water.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "stepping/step/time_scheme.hpp"

namespace lockstep {

namespace {

/// Lets what is soft take long steps; it rests where it does anyhow. Returns whether there is any.
bool take_long_steps(ParameterList& solids) {
  bool any = false;
  for (auto it = solids.begin(); it != solids.end(); ++it) {
    ParameterList& solid = solids.sublist(solids.name(it));
    if (!solid.isParameter("Time Integration"))
      continue;
    any = true;
    solid.set("Time Integration", std::string("fully-implicit"));
    if (solid.isParameter("Most Sub-Steps"))
      solid.set("Most Sub-Steps", 1);
  }
  return any;
}

/// The scene without what would stir the water.
ParameterList still(ParameterList scene, int dim) {
  const ParameterArray<double> at_rest(dim, 0.0);
  ParameterList& fluid = scene.sublist("Fluid");
  if (fluid.isParameter("Velocity"))
    fluid.set("Velocity", at_rest);
  fluid.remove("Sources", false);
  fluid.sublist("Sources");
  ParameterList& sides = scene.sublist("Domain").sublist("Sides");
  for (auto it = sides.begin(); it != sides.end(); ++it) {
    ParameterList& side = sides.sublist(sides.name(it));
    side.set("Velocity", at_rest);
    if (side.get<std::string>("Type") != "inflow")
      continue;
    side.set("Type", std::string("slip wall"));
    for (const char* of_inflow : {"Wave", "Opening", "Smoke", "Temperature"})
      side.remove(of_inflow, false);
  }
  return scene;
}

/// Closes joints that a way of a second leaves open; bodies on joints are moved for that.
template <int dim>
void close_joints(double time, Vector& way, SolidSystem<dim>& solids) {
  if (!solids.joints())
    return;
  const Vector solved(way, Teuchos::Copy);
  solids.joints()->close(time - 1, 1, *make_vector(solids.map()), solved, way);
}

/// Sets the dofs of a way to zero that are given. Local.
template <int dim>
void hold_given(const SolidSystem<dim>& solids, Vector& way) {
  const std::vector<Block> blocks = solids.blocks();
  const auto values = way.getDataNonConst();
  for (int m = 0; m < solids.n_models(); ++m) {
    const RCP<const Map> map = solids.model(m).dof_map();
    for (const GlobalIndex dof : solids.model(m).locked_dofs())
      values[blocks[m].begin + map->getLocalElement(dof)] = 0;
  }
}

}  // namespace

template <int dim>
StillWater<dim>::StillWater(const Build& build, const ParameterList& scene,
                            const SceneOptions& options)
    : build_(build), scene_(still(scene, dim)), options_(options) {
  // Round-off of stiff solids over long steps leaves no more than that.
  const double tolerance = take_long_steps(scene_.sublist("Solids")) ? 1e-10 : 1e-11;
  options_.step.solve.tolerance = std::min(options_.step.solve.tolerance, tolerance);
  options_.step.energy_budget = false;
}

template <int dim>
Components<dim> StillWater<dim>::with(const Ways& ways) const {
  Components<dim> components = build_(scene_);
  for (const RCP<const Vector>& way : ways)
    displace(*way, *components.solids);
  components.solids->set_velocity(*make_vector(components.solids->map()));
  return components;
}

template <int dim>
void StillWater<dim>::displace(const Vector& way, SolidSystem<dim>& solids) const {
  solids.move(way, options_.time.start - 1, 1);
  solids.set_velocity(*make_vector(solids.map()));
}

template <int dim>
RCP<Vector> StillWater<dim>::way_of(const Vector& unknowns, SolidSystem<dim>& solids) const {
  const auto way = rcp(new Vector(unknowns, Teuchos::Copy));
  solids.reduction().expand_change(*way);
  close_joints(options_.time.start, *way, solids);
  return way;
}

template <int dim>
RCP<Vector> StillWater<dim>::acceleration(Components<dim>& components) const {
  StageTimers timers;
  TimeScheme<dim> scheme(components, options_.step, options_.time.start, timers);
  const FluidDiscretization<dim>& fluid = *components.fluid;
  const double dt = 0.1 * std::sqrt(fluid.smallest_length() / fluid.gravity().norm());
  scheme.advance(dt);
  const RCP<Vector> velocity = components.solids->velocity();
  velocity->scale(1 / dt);
  return velocity;
}

template <int dim>
RCP<Vector> StillWater<dim>::way_down(Components<dim>& components, double dt) const {
  StageTimers timers;
  StepParts<dim> parts(components, options_.step, options_.time.start, timers);
  SolidSystem<dim>& solids = *components.solids;
  const StepTime step{options_.time.start, dt};
  parts.begin(step);
  const StepContext<dim> half{step, "S1", step.begin, dt / 2, true, solids.reduction()};
  parts.transport.begin_prediction();
  const Friction<dim> friction =
      parts.prediction.add_viscosity(half, parts.prediction.add_forces(half));
  const SolidPath<dim> path = parts.positions.find(half, friction.viscous.solid_impulse);
  const auto way = rcp(new Vector(*path.velocity, Teuchos::Copy));
  way->scale(dt);
  hold_given(solids, *way);
  close_joints(options_.time.start, *way, solids);
  return way;
}

template class StillWater<2>;
template class StillWater<3>;

}  // namespace lockstep
