// Writing of datasets; the rest of Hdf5File is in hdf5_file.cpp and hdf5_reading.cpp.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

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

template void Hdf5File::write_replicated(const std::string&, const std::vector<double>&, int,
                                         Precision);
template void Hdf5File::write_replicated(const std::string&, const std::vector<long long>&, int,
                                         Precision);
template void Hdf5File::write_replicated(const std::string&, const std::vector<int>&, int,
                                         Precision);
template void Hdf5File::write_slices(const std::string&, const std::vector<double>&, int);
template void Hdf5File::write_slices(const std::string&, const std::vector<long long>&, int);

}  // namespace lockstep
