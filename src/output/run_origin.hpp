#pragma once
#include <string>

#include "output/hdf5_file.hpp"

namespace lockstep {

/// Facts from which the run that wrote a file can be done again.
struct RunOrigin {
  std::string commit;      ///< the program's git hash, as BuildInformation has it
  std::string scene;       ///< name of the scene file without its folder; empty: there is none
  std::string parameters;  ///< the complete parameter list of the run, as XML
};

/// Returns the origin of a run of this program with `scene_file`, which may be empty.
RunOrigin run_origin(const std::string& scene_file, const std::string& parameters);

/// Writes attributes of the file: "commit", "scene" and "parameters". Collective; throws
/// OutputError.
void write_origin(Hdf5File& file, const RunOrigin& origin);

}  // namespace lockstep
