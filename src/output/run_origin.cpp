#include "output/run_origin.hpp"

#include <filesystem>

#include "output/provenance/build_information.hpp"

namespace lockstep {

RunOrigin run_origin(const std::string& scene_file, const std::string& parameters) {
  return {build_information().git_hash, std::filesystem::path(scene_file).filename().string(),
          parameters};
}

void write_origin(Hdf5File& file, const RunOrigin& origin) {
  file.write_text_attribute("/", "commit", origin.commit);
  file.write_text_attribute("/", "scene", origin.scene);
  file.write_text_attribute("/", "parameters", origin.parameters);
}

}  // namespace lockstep
