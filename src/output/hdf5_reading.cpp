// Reading from an Hdf5File. Nothing is believed: what HDF5 converts, cuts or writes beyond a buffer
// when the file holds something else than expected is refused first.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <type_traits>

#include "base/errors.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_handle.hpp"

namespace lockstep {

namespace {

std::string without_padding(const std::string& text) {
  return text.substr(0, std::min(text.find('\0'), text.size()));
}

/// Reason why values of a stored type cannot be read as T, or "".
template <typename T>
std::string wrong_kind(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  if constexpr (std::is_same_v<T, std::string>) {
    const bool fixed = kind == H5T_STRING && H5Tis_variable_str(type) == 0;
    return fixed ? "" : "it is no text of fixed length";
  } else if constexpr (std::is_floating_point_v<T>) {
    return kind == H5T_FLOAT || kind == H5T_INTEGER ? "" : "it does not hold numbers";
  } else {
    return kind == H5T_INTEGER ? "" : "it does not hold whole numbers";
  }
}

/// A dataset that was opened, and what is wrong with it.
struct OpenDataset {
  hdf5::Handle dataset, type, space;
  std::vector<hsize_t> extents;
  std::string failure;
};

OpenDataset open_dataset(hid_t file, const std::string& name) {
  OpenDataset opened;
  opened.dataset = hdf5::own_dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT));
  if (opened.dataset.valid()) {
    opened.type = hdf5::own_type(H5Dget_type(opened.dataset));
    opened.space = hdf5::own_space(H5Dget_space(opened.dataset));
  }
  if (!opened.type.valid() || !opened.space.valid()) {
    opened.failure = hdf5::last_error();
    return opened;
  }
  opened.extents.resize(
      static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(opened.space), 0)));
  if (!opened.extents.empty())
    H5Sget_simple_extent_dims(opened.space, opened.extents.data(), nullptr);
  // The compression of HDF5 does not save more.
  constexpr double largest_compression = 1032, small = 1e6;
  double n_bytes = static_cast<double>(H5Tget_size(opened.type));
  for (const hsize_t extent : opened.extents)
    n_bytes *= static_cast<double>(extent);
  if (n_bytes >
      small + largest_compression * static_cast<double>(H5Dget_storage_size(opened.dataset)))
    opened.failure = "its size does not fit what the file holds";
  return opened;
}

}  // namespace

bool Hdf5File::exists(const std::string& below) const {
  const std::string name = inside(below);
  if (name.empty() || name == "/")
    return true;
  for (std::size_t slash = name.find('/', 1);; slash = name.find('/', slash + 1)) {
    const htri_t found = H5Lexists(id_, name.substr(0, slash).c_str(), H5P_DEFAULT);
    if (found <= 0) {
      H5Eclear2(H5E_DEFAULT);
      return false;
    }
    if (slash == std::string::npos)
      return true;
  }
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  const htri_t found = H5Aexists_by_name(id_, inside(object).c_str(), name.c_str(), H5P_DEFAULT);
  H5Eclear2(H5E_DEFAULT);
  return found > 0;
}

std::vector<std::string> Hdf5File::names(const std::string& group) const {
  std::vector<std::string> result;
  const auto append = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->push_back(name);
    return 0;
  };
  const herr_t status = H5Literate_by_name(id_, inside(group).c_str(), H5_INDEX_NAME, H5_ITER_INC,
                                           nullptr, append, &result, H5P_DEFAULT);
  agree(status < 0 ? hdf5::last_error() : "", fmt::format("list the group '{}'", group));
  return result;
}

template <typename T>
T Hdf5File::read_attribute(const std::string& object, const std::string& name) const {
  T value{};
  std::string failure;
  const hdf5::Handle attribute = hdf5::own_attribute(
      H5Aopen_by_name(id_, inside(object).c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT));
  if (attribute.valid()) {
    const hdf5::Handle type = hdf5::own_type(H5Aget_type(attribute));
    const hdf5::Handle space = hdf5::own_space(H5Aget_space(attribute));
    failure = wrong_kind<T>(type);
    if (failure.empty() && H5Sget_simple_extent_npoints(space) != 1)
      failure = "it holds more or less than one value";
    herr_t status = 0;
    if constexpr (std::is_same_v<T, std::string>) {
      if (failure.empty()) {
        value.resize(H5Tget_size(type));
        status = H5Aread(attribute, type, value.data());
        value = without_padding(value);
      }
    } else if (failure.empty()) {
      status = H5Aread(attribute, hdf5::native_type<T>(), &value);
      if (status >= 0 && !std::isfinite(static_cast<double>(value)))
        failure = "it is not a finite number";
    }
    if (status < 0)
      failure = hdf5::last_error();
  } else {
    failure = hdf5::last_error();
  }
  agree(failure, fmt::format("read the attribute '{}' of '{}'", name, object));
  return value;
}

std::string Hdf5File::read_text(const std::string& name) const {
  OpenDataset opened = open_dataset(id_, inside(name));
  std::string text;
  if (opened.failure.empty())
    opened.failure = wrong_kind<std::string>(opened.type);
  if (opened.failure.empty() && H5Sget_simple_extent_npoints(opened.space) != 1)
    opened.failure = "it holds more or less than one text";
  if (opened.failure.empty()) {
    text.resize(H5Tget_size(opened.type));
    if (H5Dread(opened.dataset, opened.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0)
      opened.failure = hdf5::last_error();
  }
  agree(opened.failure, fmt::format("read the text '{}'", name));
  return without_padding(text);
}

std::vector<GlobalIndex> Hdf5File::shape(const std::string& name) const {
  const OpenDataset opened = open_dataset(id_, inside(name));
  agree(opened.failure, fmt::format("open the dataset '{}'", name));
  return {opened.extents.begin(), opened.extents.end()};
}

template <typename T>
std::vector<T> Hdf5File::read_rows(const std::string& name, GlobalIndex first_row,
                                   GlobalIndex n_rows) const {
  OpenDataset opened = open_dataset(id_, inside(name));
  if (opened.failure.empty())
    opened.failure = wrong_kind<T>(opened.type);
  std::vector<hsize_t> size = opened.extents;
  const auto n_stored = size.empty() ? GlobalIndex{0} : static_cast<GlobalIndex>(size.front());
  if (opened.failure.empty() &&
      (size.empty() || first_row < 0 || n_rows < 0 || first_row + n_rows > n_stored)) {
    opened.failure = fmt::format("rows {} to {} are not in it", first_row, first_row + n_rows);
  }
  agree(opened.failure, fmt::format("read the dataset '{}'", name));
  std::vector<hsize_t> lower(size.size(), 0);
  lower[0] = static_cast<hsize_t>(first_row);
  size[0] = static_cast<hsize_t>(n_rows);
  const hsize_t n = std::accumulate(size.begin(), size.end(), hsize_t{1}, std::multiplies<>());
  std::vector<T> values(n);
  bool done = true;
  if (n > 0) {
    const hdf5::Handle memory = hdf5::own_space(H5Screate_simple(1, &n, nullptr));
    done = H5Sselect_hyperslab(opened.space, H5S_SELECT_SET, lower.data(), nullptr, size.data(),
                               nullptr) >= 0 &&
           H5Dread(opened.dataset, hdf5::native_type<T>(), memory, opened.space, H5P_DEFAULT,
                   values.data()) >= 0;
  }
  std::string refusal = done ? "" : hdf5::last_error();
  if constexpr (std::is_floating_point_v<T>) {
    if (done && !std::all_of(values.begin(), values.end(), [](T x) { return std::isfinite(x); }))
      refusal = "it holds a number that is not finite";
  }
  agree(refusal, fmt::format("read the dataset '{}'", name));
  return values;
}

template <typename T>
std::vector<T> Hdf5File::read_all(const std::string& name) const {
  const std::vector<GlobalIndex> extents = shape(name);
  return read_rows<T>(name, 0, extents.empty() ? 0 : extents.front());
}

template double Hdf5File::read_attribute(const std::string&, const std::string&) const;
template long long Hdf5File::read_attribute(const std::string&, const std::string&) const;
template std::string Hdf5File::read_attribute(const std::string&, const std::string&) const;
template std::vector<double> Hdf5File::read_rows(const std::string&, GlobalIndex,
                                                 GlobalIndex) const;
template std::vector<long long> Hdf5File::read_rows(const std::string&, GlobalIndex,
                                                    GlobalIndex) const;
template std::vector<int> Hdf5File::read_rows(const std::string&, GlobalIndex, GlobalIndex) const;
template std::vector<double> Hdf5File::read_all(const std::string&) const;
template std::vector<long long> Hdf5File::read_all(const std::string&) const;
template std::vector<int> Hdf5File::read_all(const std::string&) const;

}  // namespace lockstep
