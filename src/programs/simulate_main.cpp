#include "programs/simulate_main.hpp"

#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <iostream>
#include <memory>
#include <set>

#include "base/lone_process.hpp"
#include "base/memory.hpp"
#include "base/shortened.hpp"
#include "base/signals.hpp"
#include "output/provenance/build_information.hpp"
#include "parameters/command_line.hpp"
#include "parameters/reference.hpp"
#include "parameters/schema/json_schema.hpp"
#include "parameters/schema/relax_ng.hpp"
#include "parameters/write.hpp"
#include "programs/load_plug_ins.hpp"
#include "programs/open_scene.hpp"
#include "scenes/expand_scene.hpp"
#include "stepping/scene_file.hpp"
#include "stepping/simulation.hpp"

namespace lockstep {
namespace {

struct Arguments {
  RunOptions run;
  std::vector<std::string> settings;
  std::vector<std::string> libraries;    // libraries of plug-ins
  std::vector<std::string> dump_system;  // solve and file
  bool validate = false, explain = false, parameters = false, list_plugins = false;
  std::string format = "text", schema;
  int dimension = 3;  // dimension of --parameters
  bool quiet = false;
};

/// A scene of a hundred bodies must not scroll away what matters.
void print_differences(const std::vector<std::string>& lines, const Log& log) {
  constexpr std::size_t most_lines = 40;
  const std::size_t shown = std::min(lines.size(), most_lines);
  for (std::size_t i = 0; i < shown; ++i)
    log.normal("  {}", lines[i]);
  if (lines.size() > shown)
    log.normal("  ... and {} more; used-parameters.xml has all.", lines.size() - shown);
}

/// Completes, builds and runs a scene. Nothing is written before it is built.
template <int dim>
int simulate(Document document, const Registries<dim>& registries, const Arguments& arguments,
             const Communicator& comm) {
  // The plug-ins say what a scene may say; the solver file, the command line, then the strict check
  // of everything.
  const ParameterList valid =
      scene_parameters<dim>(registries, scene_fluid(document, arguments.settings));
  complete_scene(document, arguments.settings, valid, comm);

  const Log log(comm, std::cout, arguments.quiet ? LogLevel::quiet : LogLevel::normal);
  if (!arguments.validate && !arguments.explain) {
    log.normal("{}", banner(comm, arguments.run.command_line));
    print_differences(differences_from_default(document.list, valid), log);
  }
  Simulation<dim> simulation(registries, document.list, arguments.run, comm, log);
  if (arguments.validate || arguments.explain) {
    log.normal("{}: valid.\n{}", arguments.run.scene_file, simulation.explain(arguments.explain));
    return 0;
  }
  return simulation.run();
}

void print_reference(const Arguments& arguments, const PlugIns& plug_ins) {
  ParameterList valid = arguments.dimension == 2 ? scene_parameters<2>(plug_ins.plane)
                                                 : scene_parameters<3>(plug_ins.space);
  declare_scene_language(valid, arguments.dimension);
  std::cout << (arguments.format == "json" ? reference_json(valid) : reference_text(valid));
}

/// Scenes as they are written, with any of the fluids.
template <int dim>
ParameterList schema_of_scenes(const Registries<dim>& registries) {
  ParameterList scene = scene_parameters<dim>(registries);
  if (registries.domains.size() > 1) {  // the fluid's own is not known
    const std::string documentation = scene.getEntry("Domain").docString();
    scene.remove("Domain");
    declare_free_sublist(scene, "Domain", documentation);
  }
  return written_scene(scene, dim);
}

void print_schema(const std::string& kind, const PlugIns& plug_ins) {
  const ParameterList plane = schema_of_scenes(plug_ins.plane);
  const ParameterList space = schema_of_scenes(plug_ins.space);
  std::cout << (kind == "json" ? json_schema(plane, space) : relax_ng(plane, space));
}

void print_plug_in(const std::string& kind, const std::string& name,
                   const std::string& documentation) {
  std::cout << kind << ": " << name << "\n    " << documentation << "\n";
}

/// All plug-ins of scenes in space; those that are in the plane alone are marked.
void print_plug_ins(const PlugIns& plug_ins) {
  const auto in_space = plug_ins.space.all(), in_plane = plug_ins.plane.all();
  std::vector<std::string> kinds;
  for (std::size_t k = 0; k < in_space.size(); ++k) {
    std::set<std::string> names;
    for (const auto& [name, documentation] : in_space[k]->documented()) {
      print_plug_in(in_space[k]->kind(), name, documentation);
      names.insert(name);
    }
    for (const auto& [name, documentation] : in_plane[k]->documented()) {
      if (names.count(name) == 0)
        print_plug_in(in_plane[k]->kind(), name + " (2D)", documentation);
    }
    kinds.push_back(in_space[k]->kind());
  }
  std::cout << fmt::format("A library of plug-ins may add to each kind of: {}.\n",
                           fmt::join(kinds, ", "));
}

void print_what_is_known(const Arguments& arguments, const PlugIns& plug_ins) {
  if (arguments.parameters)
    print_reference(arguments, plug_ins);
  else if (arguments.list_plugins)
    print_plug_ins(plug_ins);
  else
    print_schema(arguments.schema, plug_ins);
}

/// The command line. Returns false if it has asked for help or the version, which is told then.
bool read_arguments(int argc, char** argv, const Communicator& comm, Arguments& arguments) {
  CLI::App app("Runs a scene: fluid coupled to solids, from an XML or YAML file.");
  app.set_version_flag("--version", "lockstep " + build_information().version + " (" +
                                        build_information().git_hash + ")");
  app.add_option("scene", arguments.run.scene_file, "scene file (xml-params/scenes)");
  const CLI::Option* output =
      app.add_option("--output", arguments.run.output_directory, "output folder; default: output");
  app.add_option("--set", arguments.settings, "\"List/Sub list/Name=value\"; may be repeated")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  std::string steps;
  app.add_option("--steps", steps, "stop after this many steps");
  app.add_option("--end-time", arguments.run.end_time, "stop at this time [s]");
  app.add_option("--dump-system", arguments.dump_system,
                 "STEP:S1 (or F2, S2) FILE: write that system and its right-hand side, for solve")
      ->expected(2);
  const CLI::Option* restart =
      app.add_option("--restart", arguments.run.restart_file, "continue from this checkpoint");
  app.add_option("--plug-in", arguments.libraries,
                 "library of plug-ins to load, beside those that the scene names; may be repeated")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--validate", arguments.validate, "check the scene and build it, without running");
  app.add_flag("--explain", arguments.explain,
               "print what is understood, its cost, and what looks like a mistake");
  app.add_flag("--parameters", arguments.parameters, "print all parameters with documentation");
  app.add_option("--format", arguments.format, "of --parameters: text or json")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_option("--dimension", arguments.dimension, "of --parameters: 2 or 3")
      ->check(CLI::IsMember({2, 3}));
  app.add_flag("--list-plugins", arguments.list_plugins, "print all plug-ins");
  app.add_option("--schema", arguments.schema,
                 "print a schema for editors: xml (RELAX NG) or json (JSON Schema, for YAML)")
      ->check(CLI::IsMember({"xml", "json"}));
  app.add_flag("--quiet", arguments.quiet, "print warnings and errors only");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      throw InputError(shortened(error.what(), 200) + " (see simulate --help).");
    if (is_root(comm))
      app.exit(error);
    return false;
  }
  check_input(
      restart->count() == 0 || !arguments.run.restart_file.empty(),
      "--restart names no file: give the path of a checkpoint, or leave it out to begin anew.");
  check_input(output->count() == 0 || !arguments.run.output_directory.empty(),
              "--output names no folder: give its path, or leave it out for \"output\".");
  if (!arguments.dump_system.empty()) {
    arguments.run.dump_system =
        parse_dump_request(arguments.dump_system[0], arguments.dump_system[1]);
  }
  check_input(
      arguments.run.restart_file.empty() || (!arguments.validate && !arguments.explain),
      "--validate and --explain look at a scene before its first step: leave out --restart.");
  if (!steps.empty())
    arguments.run.steps = parse_count("--steps", steps);
  if (arguments.run.output_directory.empty())
    arguments.run.output_directory = "output";
  for (int i = 0; i < argc; ++i)
    arguments.run.command_line += std::string(i ? " " : "") + argv[i];
  return true;
}

int run(int argc, char** argv, const std::function<PlugIns()>& make_plug_ins,
        const Communicator& comm) {
  Arguments arguments;
  if (!read_arguments(argc, argv, comm, arguments))
    return 0;
  PlugIns plug_ins = make_plug_ins();
  if (arguments.parameters || arguments.list_plugins || !arguments.schema.empty()) {
    load_plug_ins(arguments.libraries, plug_ins, comm);
    if (is_root(comm))
      print_what_is_known(arguments, plug_ins);
    return 0;
  }
  check_input(!arguments.run.scene_file.empty(),
              "Which scene? Name a file, for example xml-params/scenes/buoyant-spheres.xml.");
  Document document =
      open_scene(arguments.run.scene_file, arguments.libraries, arguments.settings, plug_ins, comm);
  return scene_dimension(document) == 2
             ? simulate<2>(std::move(document), plug_ins.plane, arguments, comm)
             : simulate<3>(std::move(document), plug_ins.space, arguments, comm);
}

}  // namespace

int simulate_main(int argc, char** argv, const std::function<PlugIns()>& make_plug_ins) {
  ignore_closed_pipes();
  keep_freed_memory();
  expect_no_other_ranks();
  auto held_signals = std::make_unique<HeldSignals>();
  int n_for_kokkos = 1;  // the program's name alone: of --help it would print its own
  Tpetra::ScopeGuard scope(&n_for_kokkos, &argv);
  held_signals.reset();
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] { return run(argc, argv, make_plug_ins, comm); });
}

}  // namespace lockstep
