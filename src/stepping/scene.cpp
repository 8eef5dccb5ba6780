#include "stepping/scene.hpp"

#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "coupling/automatic_coupling.hpp"
#include "parameters/parameter_rule.hpp"
#include "stepping/view.hpp"

namespace lockstep {
namespace {

void declare_time(ParameterList& scene, bool has_joints) {
  ParameterList& time = declare_list(scene, "Time", "Start, end and steps of the run.");
  declare(time, "Start", 0., "Start time [s].");
  declare(time, "End", 1., "End time [s].");
  declare_at_least(
      time, "Fixed Step", 0., 0.,
      "Time step [s]; 0: chosen by the CFL number. If whole steps do not end at \"End\", all are "
      "a little shorter: forces would jump in a shorter last one.");
  declare_positive(
      time, "CFL", 0.9,
      "Cells that the fastest fluid crosses in a step (sum over the axes) [1]; any value is "
      "stable.");
  declare_positive(time, "Largest Step", 0.1, "Bound of the CFL-chosen step [s].");
  if (has_joints)
    declare_positive(
        time, "Largest Turn", 0.2,
        "Bound of the step, of a fixed one also: how far a jointed body may turn in it [rad]. "
        "Larger turns cost energy; above 0.5 joints give all of their impulse at the end of the "
        "step, but those of a mechanism that is by itself: without fluid, flesh, control, limits, "
        "contact in that step, or prescribed solids.");
  declare_between(
      time, "Order in Time", 0, 0, 2,
      "Of the scheme that moves solids and fluid together. 1: the paper's, bodies move by a solve "
      "that is thrown away. 2: both solves of a step are kept, half of the forces act before the "
      "bodies move and half after (kick, drift, kick): rigid bodies lose none of their motion to "
      "the step, with joints too; no soft solids or trapped gas. Advection has the order that "
      "\"Fluid\" says. Where nothing is free to move, 1. 0: 2 where it can be had, else 1.");
  declare_choice(
      time, "Pressure Correction", "rotational", {"rotational", "incremental", "non-incremental"},
      "Pressure of the last step in the viscous solve. rotational: with the correction by "
      "viscosity, -mu div u; incremental: without, then it needs nu dt / h^2 steps to settle; "
      "non-incremental: not at all, as in the paper; then fluid slips at walls and solids by what "
      "pressure gradients make of it in a step. No difference without viscosity.");
  declare_at_least(time, "Steps", 0, 0, "Stop after this many steps; 0: no limit.");
  declare(time, "Settle", false,
          "Before the start, move all solids that are free to where they rest in the water as it "
          "is then: rigid bodies, alone and on joints, held by their springs and mooring lines, "
          "cloth and soft solids. The water is filled in around them there. Waves and inflows "
          "begin afterwards.");
}

void declare_output(ParameterList& scene) {
  ParameterList& output = declare_list(scene, "Output", "Files that the run writes.");
  declare(output, "Frames", true, "Write frames.h5 and frames.xmf.");
  declare_optional<double>(
      output, "Frame Interval",
      "Simulated time between frames [s]: each comes with the first step at or past a multiple of "
      "it after the start, the last at the end. 0: every step; left out: every hundredth of the "
      "run, of its time or of its \"Steps\", whichever ends it.");
  set_at_least(output, "Frame Interval", 0.);
  ParameterList& checkpoints = declare_list(output, "Checkpoints", "From which a run goes on.");
  declare_optional<double>(
      checkpoints, "Interval",
      "Simulated time between two [s], counted as that of frames; 0: only at the end and when "
      "stopped; left out: every ten minutes on the clock, too.");
  set_at_least(checkpoints, "Interval", 0.);
  declare_at_least(checkpoints, "Count", 2, 1, "How many are kept.");
  declare_choice(output, "Precision", "single", {"single", "double"}, "Of the fields in frames.");
}

void declare_solver(ParameterList& scene, const StrategyRegistry& strategies) {
  ParameterList& solver = declare_list(scene, "Solver", "Solution of the S1, F2 and S2 systems.");
  declare(solver, "File", "",
          "A solver file (xml-params/solvers), relative to the scene; what the scene itself says "
          "wins.");
  declare_tolerance(
      solver, "Tolerance", 1e-8,
      "Residual of each block, scaled to its own right-hand side [1]. Left out: that of "
      "\"Strategy\" or of the solver file, if it has one; given, it wins over that.");
  declare_positive(
      solver, "Newton Iterations", 1,
      "Coupled solves in each of S1 and S2, with fully-implicit solids linearised anew "
      "about the motion of the one before. 1: linearised at the present positions.");
  declare_viscous_solve(solver);
  declare_typed_sublist(solver, "Strategy", "The solver strategy.", strategies.schemas(),
                        "schur-cg");
}

template <int dim>
void declare_observers(ParameterList& scene, const ObserverRegistry<dim>& observers) {
  std::vector<TypedSchema> types = observers.schemas();
  for (TypedSchema& type : types) {
    declare_at_least(
        type.parameters, "Interval", 0., 0.,
        "Simulated time between two looks [s], counted as that of frames; 0: after every "
        "step.");
  }
  declare_named_sublists(scene, "Observers",
                         "Measurements during the run: one sublist each, whose name is that of the "
                         "table it fills, NAME.csv in the output folder.",
                         types);
}

/// Joints exist where a program offers them.
template <int dim>
void declare_joints(ParameterList& scene, const Registries<dim>& registries) {
  if (registries.joints.empty())
    return;
  declare_named_sublists(
      scene, "Joints",
      "Joints between solids, or solids and space: one sublist each, under a name of its own.",
      registries.joints.begin()->second());
  declare_typed_sublist(scene, "Articulation", "Settings that all joints share.",
                        registries.articulations.schemas(), registries.joints.begin()->first);
}

template <int dim>
void declare_coupling(ParameterList& scene, const Registries<dim>& registries) {
  ParameterList list;
  declare(list, "Correct Buoyancy", true, "As for the coupling that is chosen.");
  auto couplings = registries.couplings.schemas();
  couplings.push_back(
      {automatic_coupling_type,
       "'flux' if there are closed solids, rigid or soft, and each is at least two cells thick and "
       "has 0.02 of the fluid's density or more (one with a given motion any density), else "
       "'mixed face'; --explain says which and why.",
       list});
  declare_typed_sublist(scene, "Coupling",
                        "Coupling of fluid and solids: their exchange of momentum.", couplings,
                        automatic_coupling_type);
}

}  // namespace

template <int dim>
ParameterList scene_parameters(const Registries<dim>& registries, const std::string& fluid) {
  const std::string& usual_fluid = registries.fluids.begin()->name;
  const bool is_known = registries.domains.count(fluid) > 0;
  ParameterList scene("Scene");
  declare_between(scene, "Dimension", dim, 2, 3, "2 or 3.");
  declare(scene, "Title", "", "One line on what the scene shows.");
  declare_optional<ParameterArray<std::string>>(
      scene, "Plug-ins",
      "Libraries of plug-ins that the scene wants, files relative to it: what they add (solids, "
      "materials, strategies, observers, ...) can be named like what ships. --plug-in adds more.");
  declare_list(scene, "Domain", "The box that holds everything, its cells and its sides.") =
      registries.domains.at(is_known ? fluid : usual_fluid)();
  declare_typed_sublist(scene, "Fluid", "The fluid.", registries.fluids.schemas(), usual_fluid);
  declare_named_sublists(scene, "Solids", "One sublist a body, under a name of its own.",
                         registries.solids.schemas());
  declare_coupling(scene, registries);
  declare_joints(scene, registries);
  auto contacts = registries.contacts.schemas();
  const std::string usual_contact = contacts.empty() ? "none" : contacts.front().type;
  contacts.push_back(
      {"none", "Solids pass through each other and through walls.", ParameterList()});
  declare_typed_sublist(scene, "Contact", "Collisions and friction.", contacts, usual_contact);
  declare_solver(scene, registries.strategies);
  declare_observers(scene, registries.observers);
  declare_time(scene, !registries.joints.empty());
  declare_output(scene);
  declare_view(scene, dim);
  return scene;
}

std::string scene_fluid(const Document& document, const std::vector<std::string>& settings) {
  const std::string setting = "Fluid/Type=";
  std::string fluid;
  if (document.list.isSublist("Fluid") &&
      document.list.sublist("Fluid").isType<std::string>("Type"))
    fluid = document.list.sublist("Fluid").get<std::string>("Type");
  for (const std::string& set : settings) {
    if (set.rfind(setting, 0) == 0)
      fluid = set.substr(setting.size());
  }
  return fluid;
}

void check_time_resolution(const TimeOptions& time) {
  constexpr double finest = 1e-6;  // part of a step
  const double dt = time.fixed_step > 0 ? time.fixed_step : time.largest_step;
  check_input(!(std::abs(time.start) * std::numeric_limits<double>::epsilon() > finest * dt),
              "In \"Time\", \"Start\" is {:g} s, from where the numbers of a computer cannot tell "
              "a step of {:g} s; start nearer to 0.",
              time.start, dt);
}

SceneOptions scene_options(const ParameterList& scene) {
  check_view(scene);
  SceneOptions options;
  const ParameterList& time = scene.sublist("Time");
  options.time.start = time.get<double>("Start");
  options.time.end = time.get<double>("End");
  options.time.fixed_step = time.get<double>("Fixed Step");
  options.time.cfl = time.get<double>("CFL");
  options.time.largest_step = time.get<double>("Largest Step");
  options.time.most_steps = time.get<int>("Steps");
  options.step.order = time.get<int>("Order in Time");
  const auto& correction = time.get<std::string>("Pressure Correction");
  options.step.prediction.incremental_pressure = correction != "non-incremental";
  options.step.prediction.rotational_pressure = correction == "rotational";
  check_input(options.time.end > options.time.start,
              "In \"Time\", \"End\" ({} s) must be later than \"Start\" ({} s).", options.time.end,
              options.time.start);
  const ParameterList& output = scene.sublist("Output");
  options.output.frames = output.get<bool>("Frames");
  if (output.isParameter("Frame Interval"))
    options.output.frame_interval = output.get<double>("Frame Interval");
  if (output.sublist("Checkpoints").isParameter("Interval"))
    options.output.checkpoint_interval = output.sublist("Checkpoints").get<double>("Interval");
  options.output.keep_checkpoints = output.sublist("Checkpoints").get<int>("Count");
  options.output.precision = output.get<std::string>("Precision");
  const ParameterList& solver = scene.sublist("Solver");
  options.step.solve.tolerance = solver.get<double>("Tolerance");
  options.step.solve.newton_iterations = solver.get<int>("Newton Iterations");
  options.step.prediction.viscous = viscous_options(solver);
  return options;
}

template ParameterList scene_parameters<2>(const Registries<2>&, const std::string&);
template ParameterList scene_parameters<3>(const Registries<3>&, const std::string&);

}  // namespace lockstep
