#pragma once
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "interfaces/plug_ins.hpp"

namespace lockstep {

/// Adds what shared libraries register (interfaces/plug_ins.hpp) to the plug-ins of this program,
/// in the order of `files`; one that is named twice counts once. Libraries stay loaded to the end
/// of the process. Throws InputError for a file that cannot be loaded, is no library of plug-ins,
/// was built with other headers than this program, or registers a name that is taken. Collective.
void load_plug_ins(const std::vector<std::string>& files, PlugIns& plug_ins,
                   const Communicator& comm);

}  // namespace lockstep
