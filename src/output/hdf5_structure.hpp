#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lockstep::hdf5 {

/// Bytes of a file in memory; what was never written takes no memory and reads as 0.
struct SparseBytes {
  static constexpr long long page_size = 4096;
  std::map<long long, std::array<char, page_size>> pages;  // by offset over page_size
  long long end = 0;                                       // behind the last byte written
  long long length = 0;                                    // length of the file once it is closed
};

/// An HDF5 file in memory that holds all of a file but its large tables: HDF5 breaks, as late as in
/// MPI_Finalize, if it cannot write what it wants to, so that it is never given a disk, which may
/// be full. The places of the tables are reserved and take no memory. Used by one rank alone.
class Structure {
 public:
  Structure();
  Structure(Structure&& other) noexcept;
  ~Structure();

  /// Returns why not, or "".
  std::string create();
  /// The HDF5 identifier (hid_t) of the file; -1 before `create` and after `copy_to`.
  std::int64_t id() const { return id_; }
  /// Leaves these bytes of the file to others.
  void reserve(long long offset, long long n_bytes) { reserved_.emplace_back(offset, n_bytes); }
  /// Closes the file and writes what it holds, the reserved bytes left out, to the same places of
  /// another one, which gets its length. Returns why not, or "".
  std::string copy_to(int descriptor);

 private:
  std::int64_t id_ = -1;
  std::unique_ptr<SparseBytes> bytes_;                     // HDF5 holds their address
  std::vector<std::pair<long long, long long>> reserved_;  // offset, number of bytes
};

}  // namespace lockstep::hdf5
