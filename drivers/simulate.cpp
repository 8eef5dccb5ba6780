// Runs one scene.
//
//   simulate xml-params/scenes/buoyant-spheres.xml --output run
//   mpirun -n 2 simulate scene.xml --set "Time/End=0.5" --set "Fluid/Density=1000"
//   simulate scene.xml --restart run/checkpoint-000120.h5 --output run
//   simulate scene.xml --validate | --explain        simulate --parameters | --list-plugins
//
// Exit codes: 0 done, 2 bad input, 3 a solve failed, 4 input or output failed, 128 + its number
// stopped by a signal after a step and its checkpoint.
#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <iostream>
#include <memory>

#include "base/lone_process.hpp"
#include "base/memory.hpp"
#include "base/shortened.hpp"
#include "base/signals.hpp"
#include "output/provenance/build_information.hpp"
#include "parameters/command_line.hpp"
#include "parameters/reference.hpp"
#include "parameters/strict_xml.hpp"
#include "parameters/validate.hpp"
#include "parameters/write.hpp"
#include "scenes/expand_scene.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "stepping/scene_file.hpp"
#include "stepping/simulation.hpp"

using namespace lockstep;

namespace {

struct Arguments {
  RunOptions run;
  std::vector<std::string> settings;
  std::vector<std::string> dump_system;  // solve and file
  bool validate = false, explain = false, parameters = false, list_plugins = false;
  std::string format = "text";
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

template <int dim>
int simulate(Document document, const Arguments& arguments, const Communicator& comm) {
  // 3. The plug-ins, and what a scene may say about them.
  const Registries<dim> registries = shipped_plug_ins<dim>();
  const ParameterList valid =
      scene_parameters<dim>(registries, scene_fluid(document, arguments.settings));

  // 4. The solver file, the command line, then the strict check of everything.
  complete_scene(document, arguments.settings, valid, comm);

  // 5. Build. Nothing has been written so far.
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

  // 6. Run.
  return simulation.run();
}

void print_reference(const Arguments& arguments) {
  ParameterList valid = arguments.dimension == 2 ? scene_parameters<2>(shipped_plug_ins<2>())
                                                 : scene_parameters<3>(shipped_plug_ins<3>());
  declare_scene_language(valid, arguments.dimension);
  std::cout << (arguments.format == "json" ? reference_json(valid) : reference_text(valid));
}

void print_plug_ins() {
  const Registries<3> registries = shipped_plug_ins<3>();
  const auto print = [](const auto& registry) {
    for (const auto& plugin : registry) {
      std::cout << registry.kind() << ": " << plugin.name << "\n    " << plugin.documentation
                << "\n";
    }
  };
  print(registries.fluids);
  print(registries.solids);
  print(registries.articulations);
  print(registries.couplings);
  print(registries.contacts);
  print(registries.strategies);
  print(registries.observers);
}

int run(int argc, char** argv, const Communicator& comm) {
  // 1. The command line.
  Arguments arguments;
  CLI::App app("Runs a scene: fluid coupled to solids, from an XML file.");
  app.set_version_flag("--version", "lockstep " + build_information().version + " (" +
                                        build_information().git_hash + ")");
  app.add_option("scene", arguments.run.scene_file, "scene file (xml-params/scenes)");
  const CLI::Option* output =
      app.add_option("--output", arguments.run.output_directory, "output folder; default: output");
  app.add_option("--set", arguments.settings, "\"List/Sub list/Name=value\"; may be repeated")
      ->expected(1)
      ->take_all();
  std::string steps;
  app.add_option("--steps", steps, "stop after this many steps");
  app.add_option("--end-time", arguments.run.end_time, "stop at this time [s]");
  app.add_option("--dump-system", arguments.dump_system,
                 "STEP:S1 (or F2, S2) FILE: write that system and its right-hand side, for solve")
      ->expected(2);
  const CLI::Option* restart =
      app.add_option("--restart", arguments.run.restart_file, "continue from this checkpoint");
  app.add_flag("--validate", arguments.validate, "check the scene and build it, without running");
  app.add_flag("--explain", arguments.explain,
               "print what is understood, its cost, and what looks like a mistake");
  app.add_flag("--parameters", arguments.parameters, "print all parameters with documentation");
  app.add_option("--format", arguments.format, "of --parameters: text or json")
      ->check(CLI::IsMember({"text", "json"}));
  app.add_option("--dimension", arguments.dimension, "of --parameters: 2 or 3")
      ->check(CLI::IsMember({2, 3}));
  app.add_flag("--list-plugins", arguments.list_plugins, "print all plug-ins");
  app.add_flag("--quiet", arguments.quiet, "print warnings and errors only");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0)
      return is_root(comm) ? app.exit(error) : 0;
    throw InputError(shortened(error.what(), 200) + " (see simulate --help).");
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
  if (arguments.parameters || arguments.list_plugins) {
    if (is_root(comm))
      arguments.parameters ? print_reference(arguments) : print_plug_ins();
    return 0;
  }
  check_input(!arguments.run.scene_file.empty(),
              "Which scene? Name a file, for example xml-params/scenes/buoyant-spheres.xml.");

  // 2. The scene file, read strictly: what it includes, its constants, defaults and copies.
  Document document = read_xml(arguments.run.scene_file, comm, FormulaPolicy::kept);
  expand_scene(document, arguments.settings, shipped_plug_ins<3>().solids.schemas(), comm);
  return scene_dimension(document) == 2 ? simulate<2>(std::move(document), arguments, comm)
                                        : simulate<3>(std::move(document), arguments, comm);
}

}  // namespace

int main(int argc, char** argv) {
  ignore_closed_pipes();
  keep_freed_memory();
  expect_no_other_ranks();
  auto held_signals = std::make_unique<HeldSignals>();
  int n_for_kokkos = 1;  // the program's name alone: of --help it would print its own
  Tpetra::ScopeGuard scope(&n_for_kokkos, &argv);
  held_signals.reset();
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] { return run(argc, argv, comm); });
}
