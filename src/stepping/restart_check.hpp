#pragma once
#include <string>

#include "output/checkpoint.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Checksums of the files that the solids of a scene are read from, one line a file: path of the
/// parameter, checksum. Such files are given relative to `scene_file`. Throws InputError for those
/// that cannot be read. Collective.
std::string checksums_of_files(const ParameterList& scene, const std::string& scene_file,
                               const Communicator& comm);

/// Holds a scene against that of the checkpoint that it is to be continued from. Throws InputError
/// with the name of the first parameter or file that differs; what stands in "Title", "Time" (but
/// for its "Start"), "Solver", "Output", "Observers" and "View" may. `files` is what
/// checksums_of_files gives for the scene.
void check_same_scene(const ParameterList& scene, const std::string& files,
                      const CheckpointHeader& header, const std::string& checkpoint);

}  // namespace lockstep
