#include "studies/frame_field.hpp"

#include "base/errors.hpp"
#include "output/xdmf.hpp"
#include "studies/frame_file.hpp"

namespace lockstep {

FrameField read_last_frame(const std::string& run_directory, const std::string& field) {
  const FrameFile file(frame_files(run_directory).back());
  FrameFile::Values dataset = file.dataset("/fluid/" + xdmf::stored_name(field));
  const auto& extents = dataset.extents;
  check_output(extents.size() == 3 || extents.size() == 4,
               "The field \"{}\" in the frames of {} has {} extents.", field, run_directory,
               extents.size());
  FrameField result;
  result.time = file.attribute("/", "time");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    result.origin[axis] = file.attribute("/fluid", "origin_" + letter);
    result.spacing[axis] = file.attribute("/fluid", "spacing_" + letter);
    result.n_cells[axis] = extents[2 - axis];
  }
  result.n_components = extents.size() == 4 ? extents[3] : 1;
  result.values = std::move(dataset.values);
  return result;
}

}  // namespace lockstep
