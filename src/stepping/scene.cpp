#include "stepping/scene.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "base/errors.hpp"
#include "base/xml_text.hpp"
#include "coupling/automatic_coupling.hpp"
#include "output/xdmf.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/shape_sizes.hpp"
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
      time, "Order in Time", 1, 1, 2,
      "Of the scheme that moves solids and fluid together. 1: the paper's, bodies move by a solve "
      "that is thrown away. 2: both solves of a step are kept, half of the forces act before the "
      "bodies move and half after (kick, drift, kick): floating and falling rigid bodies lose none "
      "of their motion to the step; no joints, soft solids or trapped gas. Advection then is of "
      "second order, too, whatever that of \"Fluid\" says. Where nothing is free to move, 1.");
  declare_choice(
      time, "Pressure Correction", "rotational", {"rotational", "incremental", "non-incremental"},
      "Pressure of the last step in the viscous solve. rotational: with the correction by "
      "viscosity, -mu div u; incremental: without, then it needs nu dt / h^2 steps to settle; "
      "non-incremental: not at all, as in the paper; then fluid slips at walls and solids by what "
      "pressure gradients make of it in a step. No difference without viscosity.");
  declare_at_least(time, "Steps", 0, 0, "Stop after this many steps; 0: no limit.");
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

/// Mesh files are given relative to the scene.
void resolve_files(ParameterList& list, const std::string& scene_file) {
  for (auto entry = list.begin(); entry != list.end(); ++entry) {
    const std::string name = list.name(entry);
    if (list.isSublist(name)) {
      resolve_files(list.sublist(name), scene_file);
    } else if (name == "File" && !list.get<std::string>(name).empty()) {
      list.set(name, resolve_path(scene_file, list.get<std::string>(name)));
    }
  }
}

/// Frames and checkpoints keep solids under their names, as far as HDF5 and ParaView can.
void check_solid_names(const ParameterList& solids) {
  std::map<std::string, std::string> stored;
  for (const auto& entry : solids) {
    const std::string& name = entry.first;
    check_input(std::none_of(name.begin(), name.end(),
                             [](unsigned char c) { return std::iscntrl(c) != 0; }),
                "In \"Solids\", the name \"{}\" holds a line break or another control character; "
                "write it in one line.",
                xml_escaped(name));
    check_input(name.find_first_not_of('.') != std::string::npos,
                "In \"Solids\", \"{}\" cannot be stored as a name; use letters or digits.", name);
    for (const std::string& kept : {name, name + " elements"}) {
      const auto [other, is_new] = stored.emplace(xdmf::stored_name(kept), name);
      check_input(
          is_new,
          "In \"Solids\", \"{}\" and \"{}\" would be stored under one name, \"{}\"; give one "
          "of them another.",
          other->second, name, other->first);
    }
  }
}

/// Refuses bodies far longer than the domain by their vertices, which alone tell how long a mesh
/// from a file is.
template <int dim>
void check_body_lengths(const SolidSystem<dim>& solids, double domain_length) {
  constexpr double most_domains = 1000;
  const SurfaceMesh<dim> surface = solids.surface();
  for (const SolidDescription& solid : solids.solids()) {
    Box<dim> box;
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
      box.extend(surface.vertices[v]);
    check_input(box.isEmpty() || box.sizes().maxCoeff() <= most_domains * domain_length,
                "The solid \"{}\" is {:g} m long, in a domain of {:g} m; lengths are in metres: "
                "scale its mesh (\"Scale\").",
                solid.name, box.isEmpty() ? 0. : box.sizes().maxCoeff(), domain_length);
  }
}

std::vector<std::pair<std::string, std::string>> jointed_pairs(const ParameterList& scene) {
  std::vector<std::pair<std::string, std::string>> pairs;
  if (!scene.isSublist("Joints"))
    return pairs;
  for (const auto& [name, entry] : entries(scene.sublist("Joints"))) {
    const auto& solids =
        scene.sublist("Joints").sublist(name).get<ParameterArray<std::string>>("Solids");
    pairs.emplace_back(solids[0], solids[1]);
  }
  return pairs;
}

template <int dim>
std::unique_ptr<SolidSystem<dim>> jointed_solids(
    const Registries<dim>& registries, const ParameterList& scene,
    std::vector<std::unique_ptr<SolidModel<dim>>> models, const SolidSetting<dim>& setting) {
  NamedLists joints;
  for (const auto& [name, entry] : entries(scene.sublist("Joints")))
    joints.emplace_back(name, scene.sublist("Joints").sublist(name));
  const ParameterList& shared = scene.sublist("Articulation");
  const double start = setting.start_time;
  const double turn = scene.sublist("Time").get<double>("Largest Turn");
  const auto system = registries.articulations.create(
      shared.get<std::string>("Type"), shared, joints,
      JointSetting<dim>{models, start, turn, setting.comm, setting.fluid_density});
  models.push_back(std::move(system->rates));
  auto solids = std::make_unique<SolidSystem<dim>>(std::move(models), setting.comm,
                                                   std::move(system->constraints));
  solids->begin_step(start, 0);
  // Leaves of the velocities what the joints admit, as after an impact.
  const RCP<const Vector> momentum = solids->explicit_momentum(start, 0);
  solids->set_velocity(*solids->velocity_of(*momentum, 0, solids->constraints(start, start)));
  return solids;
}

template <int dim>
std::unique_ptr<SolidSystem<dim>> build_solids(const Registries<dim>& registries,
                                               const ParameterList& scene,
                                               const std::string& scene_file,
                                               const SolidSetting<dim>& setting,
                                               double domain_length) {
  const ParameterList& solids = scene.sublist("Solids");
  check_solid_names(solids);
  Mistakes mistakes;
  for (const auto& entry : solids) {
    const std::string& name = entry.first;
    const ParameterList& solid = solids.sublist(name);
    if (solid.isSublist("Geometry"))
      mistakes.collect([&] {
        check_body_size(solid.sublist("Geometry"), setting.smallest_length, domain_length, dim,
                        name);
      });
  }
  mistakes.throw_all();
  std::vector<std::unique_ptr<SolidModel<dim>>> models;
  for (const auto& plugin : registries.solids) {
    NamedLists lists;
    for (auto entry = solids.begin(); entry != solids.end(); ++entry) {
      const std::string name = solids.name(entry);
      if (!solids.isSublist(name) || solids.sublist(name).get<std::string>("Type") != plugin.name) {
        continue;
      }
      lists.emplace_back(name, solids.sublist(name));
      resolve_files(lists.back().second, scene_file);
    }
    if (!lists.empty()) {
      models.push_back(registries.solids.create(plugin.name, ParameterList(), lists, setting));
    }
  }
  if (!scene.isSublist("Joints") || scene.sublist("Joints").numParams() == 0)
    return std::make_unique<SolidSystem<dim>>(std::move(models), setting.comm);
  return jointed_solids(registries, scene, std::move(models), setting);
}

constexpr const char* automatic = "automatic";

template <int dim>
void declare_coupling(ParameterList& scene, const Registries<dim>& registries) {
  ParameterList list;
  declare(list, "Correct Buoyancy", true, "As for the coupling that is chosen.");
  auto couplings = registries.couplings.schemas();
  couplings.push_back(
      {automatic,
       "'flux' if every closed solid is rigid, at least two cells thick and not far lighter than "
       "the fluid, else 'mixed face'; "
       "--explain says which and why.",
       list});
  declare_typed_sublist(scene, "Coupling",
                        "Coupling of fluid and solids: their exchange of momentum.", couplings,
                        automatic);
}

/// Makes the coupling of a scene. `note` becomes the reason of an automatic choice.
template <int dim>
std::unique_ptr<Coupling<dim>> build_coupling(const Registries<dim>& registries,
                                              const ParameterList& list,
                                              const SolidSystem<dim>& solids,
                                              const FluidDiscretization<dim>& fluid,
                                              std::string& note) {
  const auto type = list.get<std::string>("Type");
  if (type != automatic)
    return registries.couplings.create(type, list);
  const CouplingChoice choice = automatic_coupling(*solids.snapshot(), fluid.smallest_length(),
                                                   fluid.density(fluid.bounds().center()));
  note = choice.reason;
  ParameterList chosen = registries.couplings.valid_parameters(choice.type);
  chosen.set("Correct Buoyancy", list.get<bool>("Correct Buoyancy"));
  return registries.couplings.create(choice.type, chosen);
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

template <int dim>
Components<dim> build_components(const Registries<dim>& registries, const ParameterList& scene,
                                 const std::string& scene_file, const Communicator& comm) {
  const auto type_of = [&scene](const char* list) {
    return scene.sublist(list).get<std::string>("Type");
  };
  Components<dim> components;
  ParameterList fluid_list = scene.sublist("Fluid");
  resolve_files(fluid_list, scene_file);
  components.fluid =
      registries.fluids.create(type_of("Fluid"), fluid_list, scene.sublist("Domain"), comm);
  const FluidDiscretization<dim>& fluid = *components.fluid;
  const Box<dim> bounds = fluid.bounds();
  const SolidSetting<dim> solid_setting{fluid.smallest_length(), fluid.gravity(),
                                        scene.sublist("Time").get<double>("Start"), comm,
                                        fluid.density(bounds.center())};
  components.solids =
      build_solids<dim>(registries, scene, scene_file, solid_setting, bounds.sizes().maxCoeff());
  check_body_lengths(*components.solids, bounds.sizes().maxCoeff());
  components.coupling = build_coupling(registries, scene.sublist("Coupling"), *components.solids,
                                       fluid, components.coupling_note);
  const ParameterList& strategy = scene.sublist("Solver").sublist("Strategy");
  components.strategy = registries.strategies.create(strategy.get<std::string>("Type"), strategy);
  const auto* joints = std::as_const(*components.solids).joints();
  check_input(!joints || joints->limited().empty() || type_of("Contact") != "none",
              "The joint \"{}\" has limits, which contact keeps; \"Contact/Type\" must not be "
              "\"none\".",
              joints ? joints->limited() : "");
  if (type_of("Contact") != "none") {
    ContactSetting<dim> setting;
    setting.domain = bounds;
    setting.smallest_length = fluid.smallest_length();
    setting.comm = comm;
    for (const SolidDescription& solid : components.solids->solids())
      setting.solids.push_back(solid.name);
    setting.jointed = jointed_pairs(scene);
    setting.closed_sides = fluid.closed_sides();
    setting.wall_velocity = [&fluid](int axis, int end, double time) {
      return fluid.wall_velocity(axis, end, time);
    };
    components.contact =
        registries.contacts.create(type_of("Contact"), scene.sublist("Contact"), setting);
  }
  return components;
}

template ParameterList scene_parameters<2>(const Registries<2>&, const std::string&);
template ParameterList scene_parameters<3>(const Registries<3>&, const std::string&);
template Components<2> build_components<2>(const Registries<2>&, const ParameterList&,
                                           const std::string&, const Communicator&);
template Components<3> build_components<3>(const Registries<3>&, const ParameterList&,
                                           const std::string&, const Communicator&);

}  // namespace lockstep
