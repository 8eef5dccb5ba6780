#include "studies/frame_file.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <numeric>

#include "base/errors.hpp"

namespace lockstep {

namespace fs = std::filesystem;

std::vector<std::string> frame_files(const std::string& run_directory) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& item : fs::directory_iterator(run_directory + "/frames", error)) {
    if (item.path().extension() == ".h5")
      files.push_back(item.path().string());
  }
  check_output(!files.empty(), "{} holds no frame; set \"Output/Frames\" to true.", run_directory);
  std::sort(files.begin(), files.end());
  return files;
}

FrameFile::FrameFile(const std::string& path) : path_(path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures become exceptions here
  file_ = hdf5::Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  check_output(file_.valid(), "Cannot read the frame '{}'.", path);
}

double FrameFile::attribute(const std::string& object, const std::string& name) const {
  double value = 0;
  const hdf5::Handle attribute = hdf5::own_attribute(
      H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  check_output(attribute.valid() && H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0,
               "The frame '{}' lacks the attribute \"{}\" of \"{}\".", path_, name, object);
  return value;
}

FrameFile::Values FrameFile::dataset(const std::string& name) const {
  const hdf5::Handle dataset = hdf5::own_dataset(H5Dopen2(file_, name.c_str(), H5P_DEFAULT));
  check_output(dataset.valid(), "The frame '{}' has no dataset \"{}\".", path_, name);
  const hdf5::Handle space = hdf5::own_space(H5Dget_space(dataset));
  std::vector<hsize_t> extents(H5Sget_simple_extent_ndims(space));
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  Values result;
  result.extents.assign(extents.begin(), extents.end());
  result.values.resize(
      std::accumulate(extents.begin(), extents.end(), std::size_t{1}, std::multiplies<>()));
  check_output(
      H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()) >= 0,
      "Cannot read \"{}\" of '{}'.", name, path_);
  return result;
}

}  // namespace lockstep
