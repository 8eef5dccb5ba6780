// Datasets of an Hdf5File, written and read. Nothing that is read is believed: what HDF5 converts,
// cuts or writes beyond a buffer when the file holds something else than expected is refused first.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>
#include <type_traits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/exchange.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_handle.hpp"

namespace lockstep {

namespace {
template <typename T>
std::string not_finite(const std::vector<T>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(static_cast<double>(values[i]))) {
      return fmt::format("it holds {}, which is not a finite number", values[i]);
    }
  }
  return "";
}

GlobalIndex n_elements(const std::vector<GlobalIndex>& extents) {
  return std::accumulate(extents.begin(), extents.end(), GlobalIndex{1},
                         std::multiplies<GlobalIndex>());
}

/// Calls visit(first cell in the box, number of cells) for each row of each block, in order.
template <typename Visit>
void for_each_row(const std::array<int, 3>& n_cells, const std::vector<CellBlock>& blocks,
                  const Visit& visit) {
  for (const CellBlock& block : blocks) {
    for (GlobalIndex k = block.lower[2]; k < block.lower[2] + block.size[2]; ++k) {
      for (GlobalIndex j = block.lower[1]; j < block.lower[1] + block.size[1]; ++j) {
        visit((k * n_cells[1] + j) * n_cells[0] + block.lower[0], block.size[0]);
      }
    }
  }
}

std::string check_blocks(const std::array<int, 3>& n_cells, const std::vector<CellBlock>& blocks,
                         std::size_t n_values, int n_components) {
  std::size_t expected = 0;
  for (const CellBlock& block : blocks) {
    std::size_t cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
      if (block.lower[axis] < 0 || block.size[axis] < 1 ||
          block.lower[axis] + block.size[axis] > n_cells[axis]) {
        return "a block reaches out of the box";
      }
      cells *= static_cast<std::size_t>(block.size[axis]);
    }
    expected += cells;
  }
  return expected * n_components == n_values ? "" : "the values do not match the blocks";
}

/// The range of cells of a box, in the order of the dataset, that this rank writes.
struct CellRange {
  GlobalIndex first;
  std::vector<double> values;  ///< n_stored to a cell
  std::string failure;
};

/// Collective: brings the cells from the blocks of all ranks to the ranks that write them, so that
/// each rank writes one contiguous piece. Vectors are padded to n_stored components.
CellRange gather_range(const Communicator& comm, const std::array<int, 3>& n_cells,
                       const std::vector<CellBlock>& blocks, int n_components, int n_stored,
                       const std::vector<double>& values) {
  const int n_ranks = comm->getSize();
  const GlobalIndex n = GlobalIndex{n_cells[0]} * n_cells[1] * n_cells[2];
  std::vector<std::vector<long long>> runs(n_ranks);  // first cell and number of cells
  std::vector<std::vector<double>> numbers(n_ranks);
  auto value = values.begin();
  for_each_row(n_cells, blocks, [&](GlobalIndex cell, GlobalIndex n_row) {
    for (const GlobalIndex end = cell + n_row; cell < end;) {
      const int rank = rank_of(cell, n, n_ranks);
      const GlobalIndex length = std::min(end, first_of_rank(n, rank + 1, n_ranks)) - cell;
      runs[rank].insert(runs[rank].end(), {cell, length});
      numbers[rank].insert(numbers[rank].end(), value, value + length * n_components);
      value += length * n_components;
      cell += length;
    }
  });
  const std::vector<long long> my_runs = send_to_ranks(comm, runs);
  const std::vector<double> my_numbers = send_to_ranks(comm, numbers);

  CellRange range{first_of_rank(n, comm->getRank(), n_ranks), {}, ""};
  const GlobalIndex n_mine = first_of_rank(n, comm->getRank() + 1, n_ranks) - range.first;
  range.values.assign(static_cast<std::size_t>(n_mine * n_stored), 0.0);
  std::vector<bool> set(static_cast<std::size_t>(n_mine), false);
  std::size_t next = 0;
  for (std::size_t run = 0; run < my_runs.size(); run += 2) {
    for (GlobalIndex i = 0; i < my_runs[run + 1]; ++i, next += n_components) {
      const auto cell = static_cast<std::size_t>(my_runs[run] + i - range.first);
      if (set[cell])
        range.failure = "two blocks share a cell";
      set[cell] = true;
      std::copy_n(my_numbers.begin() + next, n_components, range.values.begin() + cell * n_stored);
    }
  }
  return range;
}
}  // namespace

template <typename T>
GlobalIndex Hdf5File::reserve(const std::string& name, const std::vector<GlobalIndex>& extents) {
  const GlobalIndex n_bytes = n_elements(extents) * static_cast<GlobalIndex>(sizeof(T));
  std::string failure;
  long long offset = 0;
  if (is_root(comm_)) {
    const std::vector<hsize_t> shape(extents.begin(), extents.end());
    const hdf5::Handle space =
        hdf5::own_space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr));
    const hdf5::Handle creation = hdf5::own_properties(H5Pcreate(H5P_DATASET_CREATE));
    H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const hdf5::Handle links = hdf5::own_properties(H5Pcreate(H5P_LINK_CREATE));
    H5Pset_create_intermediate_group(links, 1);
    const hdf5::Handle dataset = hdf5::own_dataset(H5Dcreate2(
        id(), inside(name).c_str(), hdf5::native_type<T>(), space, links, creation, H5P_DEFAULT));
    if (!dataset.valid())
      failure = hdf5::last_error();
    if (failure.empty() && n_elements(extents) > 0) {
      const haddr_t address = H5Dget_offset(dataset);
      if (address == HADDR_UNDEF)
        failure = hdf5::last_error();
      offset = static_cast<long long>(address);
      structure_.reserve(offset, n_bytes);
    }
  }
  agree(failure, fmt::format("create the dataset '{}'", name));
  MPI_Bcast(&offset, 1, MPI_LONG_LONG, 0, raw_communicator(comm_));
  return offset;
}

template <typename T>
void Hdf5File::write_values(const std::string& name, GlobalIndex offset, GlobalIndex first,
                            const std::vector<T>& values) {
  const int error = write_fully_at(descriptor_, reinterpret_cast<const char*>(values.data()),
                                   values.size() * sizeof(T),
                                   offset + first * static_cast<GlobalIndex>(sizeof(T)));
  agree(error == 0 ? "" : std::strerror(error), fmt::format("write the dataset '{}'", name));
}

template <typename T>
void Hdf5File::write_compressed(const std::string& name, const std::vector<GlobalIndex>& extents,
                                const std::vector<T>& values, int level) {
  constexpr hsize_t chunk_edge = 32;
  const std::vector<hsize_t> shape(extents.begin(), extents.end());
  std::vector<hsize_t> chunk(shape);
  for (hsize_t& edge : chunk) {
    edge = std::min(edge, chunk_edge);
  }
  const int rank = static_cast<int>(shape.size());
  const hdf5::Handle space = hdf5::own_space(H5Screate_simple(rank, shape.data(), nullptr));
  const hdf5::Handle creation = hdf5::own_properties(H5Pcreate(H5P_DATASET_CREATE));
  H5Pset_chunk(creation, rank, chunk.data());
  H5Pset_deflate(creation, static_cast<unsigned>(level));
  const hdf5::Handle links = hdf5::own_properties(H5Pcreate(H5P_LINK_CREATE));
  H5Pset_create_intermediate_group(links, 1);
  const hid_t type = hdf5::native_type<T>();
  const hdf5::Handle dataset = hdf5::own_dataset(
      H5Dcreate2(id(), inside(name).c_str(), type, space, links, creation, H5P_DEFAULT));
  const bool written = dataset.valid() &&
                       H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0 &&
                       H5Dflush(dataset) >= 0;
  agree(written ? "" : hdf5::last_error(), fmt::format("write the dataset '{}'", name));
}

template <typename T>
void Hdf5File::write_table(const std::string& name, const std::vector<T>& values,
                           int n_components) {
  agree(not_finite(values), fmt::format("write the dataset '{}'", name));
  const auto mine = static_cast<GlobalIndex>(values.size());
  const GlobalIndex first = exclusive_sum(comm_, mine);
  std::vector<GlobalIndex> extents = {sum_all(comm_, mine) / n_components};
  if (n_components > 1)
    extents.push_back(n_components);
  write_values(name, reserve<T>(name, extents), first, values);
}

template <typename T>
void Hdf5File::write_replicated(const std::string& name, const std::vector<T>& values,
                                int n_components, Precision precision) {
  const std::vector<T> mine = is_root(comm_) ? values : std::vector<T>();
  if (std::is_same_v<T, double> && precision == Precision::single_precision) {
    write_table(name, std::vector<float>(mine.begin(), mine.end()), n_components);
  } else {
    write_table(name, mine, n_components);
  }
}

template <typename T>
void Hdf5File::write_slices(const std::string& name, const std::vector<T>& values,
                            int n_components) {
  write_table(name, values, n_components);
}

template <typename T>
void Hdf5File::write_cells(const std::string& name, const std::vector<GlobalIndex>& extents,
                           GlobalIndex first, const std::vector<double>& values,
                           int compression_level) {
  const std::vector<T> stored(values.begin(), values.end());
  agree(not_finite(stored), fmt::format("write the dataset '{}'", name));
  if (compression_level > 0 && comm_->getSize() == 1) {
    write_compressed(name, extents, stored, compression_level);
  } else {
    write_values(name, reserve<T>(name, extents), first, stored);
  }
}

void Hdf5File::write_box(const std::string& name, const std::array<int, 3>& n_cells,
                         int n_components, const std::vector<CellBlock>& blocks,
                         const std::vector<double>& values, const BoxStorage& storage) {
  const std::string action = fmt::format("write the dataset '{}'", name);
  agree(check_blocks(n_cells, blocks, values.size(), n_components), action);
  const int n_stored = n_components == 1 ? 1 : 3;
  const CellRange range = gather_range(comm_, n_cells, blocks, n_components, n_stored, values);
  agree(range.failure, action);
  std::vector<GlobalIndex> extents(n_cells.rbegin(), n_cells.rend());
  if (n_stored > 1)
    extents.push_back(n_stored);
  const GlobalIndex first = range.first * n_stored;
  if (storage.precision == Precision::single_precision) {
    write_cells<float>(name, extents, first, range.values, storage.compression_level);
  } else {
    write_cells<double>(name, extents, first, range.values, storage.compression_level);
  }
}

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

template void Hdf5File::write_replicated(const std::string&, const std::vector<double>&, int,
                                         Precision);
template void Hdf5File::write_replicated(const std::string&, const std::vector<long long>&, int,
                                         Precision);
template void Hdf5File::write_replicated(const std::string&, const std::vector<int>&, int,
                                         Precision);
template void Hdf5File::write_slices(const std::string&, const std::vector<double>&, int);
template void Hdf5File::write_slices(const std::string&, const std::vector<long long>&, int);
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
