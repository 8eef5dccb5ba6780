#include "studies/frame_field.hpp"

#include <hdf5.h>

#include <filesystem>
#include <numeric>

#include "base/errors.hpp"
#include "output/hdf5_handle.hpp"

namespace lockstep {

namespace fs = std::filesystem;

namespace {

std::string last_frame_file(const std::string& run_directory) {
  std::string last;
  std::error_code error;
  for (const auto& item : fs::directory_iterator(run_directory + "/frames", error)) {
    if (item.path().extension() == ".h5")
      last = std::max(last, item.path().string());
  }
  check_output(!last.empty(), "{} holds no frame; set \"Output/Frames\" to true.", run_directory);
  return last;
}

double read_number(hid_t file, const std::string& object, const std::string& name) {
  double value = 0;
  const hdf5::Handle attribute = hdf5::own_attribute(
      H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  check_output(attribute.valid() && H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) >= 0,
               "A frame lacks the attribute \"{}\" of \"{}\".", name, object);
  return value;
}

}  // namespace

FrameField read_last_frame(const std::string& run_directory, const std::string& field) {
  const std::string path = last_frame_file(run_directory);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // failures become exceptions here
  const hdf5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  check_output(file.valid(), "Cannot read the frame '{}'.", path);
  const std::string name = "/fluid/" + field;
  const hdf5::Handle dataset = hdf5::own_dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  check_output(dataset.valid(), "The frame '{}' has no field \"{}\".", path, name);
  const hdf5::Handle space = hdf5::own_space(H5Dget_space(dataset));
  std::array<hsize_t, 4> extents{1, 1, 1, 1};
  const int rank = H5Sget_simple_extent_ndims(space);
  check_output(rank == 3 || rank == 4, "The field \"{}\" of '{}' has {} extents.", name, path,
               rank);
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  FrameField result;
  result.time = read_number(file, "/", "time");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    result.origin[axis] = read_number(file, "/fluid", "origin_" + letter);
    result.spacing[axis] = read_number(file, "/fluid", "spacing_" + letter);
    result.n_cells[axis] = extents[2 - axis];
  }
  result.n_components = extents[3];
  result.values.resize(
      std::accumulate(extents.begin(), extents.end(), std::size_t{1}, std::multiplies<>()));
  check_output(
      H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, result.values.data()) >= 0,
      "Cannot read \"{}\" of '{}'.", name, path);
  return result;
}

}  // namespace lockstep
