#include "programs/open_scene.hpp"

#include "parameters/strict_xml.hpp"
#include "programs/load_plug_ins.hpp"
#include "scenes/expand_scene.hpp"
#include "scenes/include.hpp"

namespace lockstep {

Document open_scene(const std::string& file, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm) {
  return open_scene(read_xml(file, comm, FormulaPolicy::kept), libraries, settings, plug_ins, comm);
}

Document open_scene(Document document, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm) {
  include_scenes(document, settings, comm);
  add_plug_in_files(libraries, document);
  load_plug_ins(plug_in_files(document), plug_ins, comm);
  expand_scene(document, settings, plug_ins.space.solids.schemas());
  return document;
}

}  // namespace lockstep
