#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/communicator.hpp"
#include "output/atomic_file.hpp"

/// The folder of a run and the small files that tell what was run. All functions are collective;
/// rank 0 does the work and its arguments count.
namespace lockstep {

/// Creates the folder with those above it. Throws InputError if the path is a file, if the folder
/// cannot be created or written to, or if its "frames" is a link or a file.
void create_output_directory(const Communicator& comm, const std::string& directory);

/// DIRECTORY/input.xml, a byte copy of the scene file (input.yaml of one in YAML), and
/// used-parameters.xml, the complete list with all defaults; both are that if there is no scene
/// file (an empty path). Throws OutputError.
void record_input(const Communicator& comm, const std::string& directory,
                  const std::string& input_path, const std::string& used_parameters);

/// Text of summary.json, in which bytes of paths that are no UTF-8 are replaced. Local.
std::string summary_text(const nlohmann::ordered_json& summary);

/// DIRECTORY/summary.json. Throws OutputError.
void write_summary(const Communicator& comm, const std::string& directory,
                   const nlohmann::ordered_json& summary);

}  // namespace lockstep
