// A program with two plug-ins of its own, an observer and an interface model, under names of their
// own in scene files: simulate SCENE.xml OUTPUT_FOLDER [--set "List/Name=value"]... [--restart
// CHECKPOINT]
#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <iostream>

#include "column_fluid.hpp"
#include "given_level.hpp"
#include "parameters/strict_xml.hpp"
#include "piston.hpp"
#include "scenes/expand_scene.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "stepping/scene_file.hpp"
#include "stepping/simulation.hpp"
#include "stroke.hpp"
using namespace lockstep;

ParameterList column_parameters() {
  ParameterList list;
  declare_positive(list, "Density", 1000., "Of the fluid [kg/m^3].");
  declare(list, "Gravity", 0., "Along the channel [m/s^2].");
  return list;
}

ParameterList channel_parameters() {
  ParameterList list;
  declare_positive(list, "Length", 2., "Along x, from 0 [m].");
  declare_positive(list, "Width", 0.5, "Across, from y = 0 [m].");
  declare_positive(list, "Cells", 20, "Along the channel.");
  return list;
}

std::unique_ptr<ColumnFluid> make_column(const ParameterList& list, const ParameterList& domain,
                                         const Communicator& comm) {
  return std::make_unique<ColumnFluid>(
      ColumnFluid::Options{domain.get<int>("Cells"), domain.get<double>("Length"),
                           domain.get<double>("Width"), list.get<double>("Density"),
                           list.get<double>("Gravity")},
      comm);
}

ParameterList piston_parameters() {
  ParameterList list;
  declare(list, "Position", 0.7, "Along the channel [m].");
  declare_positive(list, "Width", 0.5, "Of the channel [m].");
  declare_positive(list, "Mass", 100., "[kg/m].");
  declare(list, "Force", 50., "Along the channel [N/m].");
  return list;
}

std::unique_ptr<Piston> make_piston(const ParameterList&, const NamedLists& pistons,
                                    const SolidSetting<2>& setting) {
  check_input(pistons.size() == 1, "A channel takes one piston, not {}.", pistons.size());
  const ParameterList& list = pistons[0].second;
  return std::make_unique<Piston>(
      Piston::Options{list.get<double>("Position"), list.get<double>("Width"),
                      list.get<double>("Mass"), list.get<double>("Force")},
      setting.comm);
}

ParameterList level_parameters() {
  ParameterList list;
  declare(list, "Height", 0., "Of the surface at the start [m].");
  declare(list, "Speed", 0., "At which it rises [m/s].");
  return list;
}

std::unique_ptr<GivenLevel> make_level(const ParameterList& list, const MacDomain<2>& domain) {
  return std::make_unique<GivenLevel>(
      GivenLevel::Options{list.get<double>("Height"), list.get<double>("Speed")}, domain);
}

Registries<2> plug_ins() {
  const auto interfaces = shipped_interface_models<2>();
  interfaces->add("given level", "A flat surface at a given height.", level_parameters, make_level);
  Registries<2> registries = shipped_plug_ins<2>(interfaces);
  registries.fluids.add("column", "A straight channel.", column_parameters, make_column);
  registries.domains["column"] = channel_parameters;
  registries.solids.add("piston", "A plate across a channel.", piston_parameters, make_piston);
  registries.observers.add(
      "stroke", "How far the first solid has come.", [] { return ParameterList(); },
      [](const ParameterList&) { return std::make_unique<Stroke>(); });
  return registries;
}

int run(int argc, char** argv, const Communicator& comm) {
  RunOptions options;
  std::vector<std::string> settings;
  CLI::App app("Runs a scene with plug-ins of its own.");
  app.add_option("scene", options.scene_file)->required();
  app.add_option("output", options.output_directory)->required();
  app.add_option("--set", settings)->expected(1)->take_all();
  app.add_option("--restart", options.restart_file);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string(error.what()) +
                     "\nUsage: simulate SCENE.xml OUTPUT_FOLDER [--set \"List/Name=value\"]... "
                     "[--restart CHECKPOINT]");
  }
  Document scene = read_xml(options.scene_file, comm, FormulaPolicy::kept);
  const Registries<2> registries = plug_ins();
  expand_scene(scene, settings, registries.solids.schemas(), comm);
  complete_scene(scene, settings, scene_parameters<2>(registries, scene_fluid(scene, settings)),
                 comm);
  const Log log(comm, std::cout, LogLevel::normal);
  return Simulation<2>(registries, scene.list, options, comm, log).run();
}

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] { return run(argc, argv, comm); });
}
