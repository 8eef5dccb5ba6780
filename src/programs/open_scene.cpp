#include "programs/open_scene.hpp"

#include "parameters/files/parameter_file.hpp"
#include "parameters/untyped.hpp"
#include "programs/load_plug_ins.hpp"
#include "scenes/expand_scene.hpp"
#include "scenes/include.hpp"
#include "stepping/scene.hpp"

namespace lockstep {
namespace {

template <int dim>
void assign_types_of(Document& document, const std::vector<std::string>& settings,
                     const Registries<dim>& registries) {
  const ParameterList valid = scene_parameters<dim>(registries, scene_fluid(document, settings));
  assign_types(document.list, written_scene(valid, dim), document.source, FormulaPolicy::kept);
}

/// Values of a scene in YAML get the types that the plug-ins say, which the dimension and the fluid
/// choose.
void assign_scene_types(Document& document, const std::vector<std::string>& settings,
                        const PlugIns& plug_ins) {
  assign_type(document.list, "Dimension", ValueType::integer, document.source, "");
  if (document.list.isSublist("Fluid"))
    assign_type(document.list.sublist("Fluid"), "Type", ValueType::text, document.source, "Fluid");
  if (scene_dimension(document) == 2)
    assign_types_of<2>(document, settings, plug_ins.plane);
  else
    assign_types_of<3>(document, settings, plug_ins.space);
}

}  // namespace

Document open_scene(const std::string& file, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm) {
  return open_scene(read_parameters(file, comm, FormulaPolicy::kept), libraries, settings, plug_ins,
                    comm);
}

Document open_scene(Document document, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm) {
  include_scenes(document, settings, comm);
  add_plug_in_files(libraries, document);
  load_plug_ins(plug_in_files(document), plug_ins, comm);
  if (has_untyped(document.list))
    assign_scene_types(document, settings, plug_ins);
  expand_scene(document, settings, plug_ins.space.solids.schemas());
  return document;
}

}  // namespace lockstep
