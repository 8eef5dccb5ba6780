#pragma once
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "interfaces/plug_ins.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Reads a scene file strictly: what it includes, its libraries of plug-ins, its constants,
/// defaults and copies. Returns plain parameters, not checked yet. Libraries that `libraries` or
/// the scene name add to `plug_ins`; what concerns all this is taken out of `settings`, the `--set`
/// assignments. Throws InputError. Collective.
Document open_scene(const std::string& file, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm);
/// Likewise a scene that was read already, with FormulaPolicy::kept.
Document open_scene(Document document, const std::vector<std::string>& libraries,
                    std::vector<std::string>& settings, PlugIns& plug_ins,
                    const Communicator& comm);

}  // namespace lockstep
