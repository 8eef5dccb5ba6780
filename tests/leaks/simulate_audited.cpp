// `simulate` with interfaces that end the run where liquid goes through a solid:
//   simulate_audited SCENE.xml --output FOLDER [--steps N] [--end-time T] [--set
//   "List/Name=value"]...
//   [--restart CHECKPOINT] [--quiet]
#include <CLI/CLI.hpp>
#include <Tpetra_Core.hpp>
#include <iostream>

#include "leaks/leak_audit.hpp"
#include "programs/open_scene.hpp"
#include "scenes/expand_scene.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "stepping/scene_file.hpp"
#include "stepping/simulation.hpp"

namespace lockstep::test {
namespace {

/// An interface that ships, audited in each step.
template <int dim, typename Interface>
class Audited : public Interface {
 public:
  template <typename Parameters>
  Audited(const MacDomain<dim>& domain, const Parameters& parameters)
      : Interface(domain, parameters), domain_(domain), audit_(domain) {}

  void advance(const InterfaceStep<dim>& step) override {
    const auto liquid = [&](const SolidCells<dim>& solids) {
      return cells_with_liquid<dim>(domain_, solids, step.kept, *this);
    };
    audit_.open(step, liquid);
    Interface::advance(step);
    audit_.close(step, liquid);
  }

 private:
  const MacDomain<dim>& domain_;
  LeakAudit<dim> audit_;
};

template <int dim>
InterfaceRegistry<dim> audited(const InterfaceRegistry<dim>& all_shipped) {
  InterfaceRegistry<dim> interfaces("interface model");
  for (const auto& shipped : all_shipped)
    interfaces.add(shipped.name, shipped.documentation, shipped.valid_parameters,
                   [is_fractions = shipped.name == "volume of fluid"](
                       const ParameterList& list,
                       const MacDomain<dim>& domain) -> std::unique_ptr<InterfaceModel<dim>> {
                     if (is_fractions)
                       return std::make_unique<Audited<dim, VolumeOfFluid<dim>>>(
                           domain, read_volume_of_fluid_parameters(list));
                     return std::make_unique<Audited<dim, LevelSet<dim>>>(
                         domain, read_level_set_parameters(list));
                   });
  return interfaces;
}

template <int dim>
int simulate(Document scene, const Registries<dim>& registries,
             const std::vector<std::string>& settings, const RunOptions& options,
             const Communicator& comm) {
  auto& interfaces = registries.template part<InterfaceRegistry<dim>>();
  interfaces = audited<dim>(interfaces);
  complete_scene(scene, settings, scene_parameters<dim>(registries, scene_fluid(scene, settings)),
                 comm);
  const Log log(comm, std::cout, LogLevel::quiet);
  return Simulation<dim>(registries, scene.list, options, comm, log).run();
}

int run(int argc, char** argv, const Communicator& comm) {
  RunOptions options;
  std::vector<std::string> settings;
  CLI::App app("Runs a scene and audits its liquid.");
  app.add_option("scene", options.scene_file)->required();
  app.add_option("--output", options.output_directory)->required();
  app.add_option("--steps", options.steps);
  app.add_option("--end-time", options.end_time);
  app.add_option("--set", settings)->expected(1)->take_all();
  app.add_option("--restart", options.restart_file);
  app.add_flag("--quiet");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    throw InputError(error.what());
  }
  PlugIns plug_ins = shipped_plug_ins();
  Document scene = open_scene(options.scene_file, {}, settings, plug_ins, comm);
  return scene_dimension(scene) == 2
             ? simulate<2>(std::move(scene), plug_ins.plane, settings, options, comm)
             : simulate<3>(std::move(scene), plug_ins.space, settings, options, comm);
}

}  // namespace
}  // namespace lockstep::test

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const lockstep::Communicator comm = Tpetra::getDefaultComm();
  return lockstep::run_and_report(comm, [&] { return lockstep::test::run(argc, argv, comm); });
}
