#pragma once
#include <string>
#include <vector>

#include "output/hdf5_handle.hpp"

namespace lockstep {

/// The frames of a run in the order of time. Throws OutputError if there are none.
std::vector<std::string> frame_files(const std::string& run_directory);

/// One frame, read without MPI. All throw OutputError for what is not there.
class FrameFile {
 public:
  explicit FrameFile(const std::string& path);

  double attribute(const std::string& object, const std::string& name) const;
  /// Values of a dataset and its extents.
  struct Values {
    std::vector<std::size_t> extents;
    std::vector<double> values;
  };
  Values dataset(const std::string& name) const;

 private:
  std::string path_;
  hdf5::Handle file_;
};

}  // namespace lockstep
