#pragma once
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Merges the scene files that "Include" names (a string, or an array of them) into the document,
/// paths relative to the file that names them; they may include others. What a file itself says
/// wins over what it includes, and of several the first wins. Throws InputError, also for a file
/// that includes itself. Collective.
///
/// Takes the `--set` assignments of "Include" and "Plug-ins" out of `settings`: what the first
/// names wins over the document, paths are relative to the scene. "Plug-ins", a string or an array,
/// is an array of those of all these files then.
void include_scenes(Document& document, std::vector<std::string>& settings,
                    const Communicator& comm);

/// The libraries of plug-ins that a scene names (after `include_scenes`), as paths. Throws
/// InputError.
std::vector<std::string> plug_in_files(const Document& document);
/// Adds such files, relative to the working folder, to those of the scene. Throws InputError.
void add_plug_in_files(const std::vector<std::string>& files, Document& document);

}  // namespace lockstep
