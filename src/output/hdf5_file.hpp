#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "output/hdf5_structure.hpp"

namespace lockstep {

/// Size of floating point numbers in a file.
enum class Precision { single_precision, double_precision };

/// A box of cells, in x, y, z order (in 2D lower[2] = 0 and size[2] = 1).
struct CellBlock {
  std::array<int, 3> lower;
  std::array<int, 3> size;
};

/// Layout of a box of cells in a file.
struct BoxStorage {
  Precision precision = Precision::single_precision;
  /// 0 (none) to 9, deflate. On one rank only; several ranks write uncompressed.
  int compression_level = 0;
};

/// One HDF5 file, used by all ranks of a communicator together: every member function is
/// collective. Every failure (full disk, no permission, truncated file, number that is not finite)
/// is an OutputError on every rank, with the name of the file and the reason.
///
/// A file being created carries the name `path.part` until `close` has succeeded; if `close` is
/// never reached, or fails, nothing is left of it.
///
/// Rank 0 alone makes the structure of the file, in memory; every rank writes its part of the
/// numbers straight to the place that HDF5 has reserved for them, and `close` adds the structure.
/// HDF5's own MPI driver is avoided: with Open MPI 4.1 a collective write to a full disk hangs.
///
/// Contents that are read must match the request: another kind of number, another shape and a
/// size that the file cannot hold are failures as well.
class Hdf5File {
 public:
  static Hdf5File create(const Communicator& comm, const std::string& path);
  /// Opens a file for reading only.
  static Hdf5File open(const Communicator& comm, const std::string& path);
  Hdf5File(Hdf5File&& other) noexcept;
  Hdf5File& operator=(Hdf5File&&) = delete;
  ~Hdf5File();

  /// Forces everything to disk and gives the file its final name.
  void close();
  /// Closes the file with a checksum at its end (output/checksum.hpp).
  void close_with_checksum();

  const std::string& path() const { return path_; }
  const Communicator& communicator() const { return comm_; }

  /// From here on all names are those of things below this group, "/" is the group itself, until
  /// the next call; an empty name ends it.
  void enter(const std::string& group) { group_ = group; }
  /// Creates the group and the groups above it.
  void create_group(const std::string& name);
  /// This and everything else that reads needs a file from `open`.
  bool exists(const std::string& name) const;
  bool has_attribute(const std::string& object, const std::string& name) const;
  /// Names directly below a group, in alphabetical order.
  std::vector<std::string> names(const std::string& group) const;
  /// A name in this file for an object of another; `file` is relative to the folder of this file.
  void link_external(const std::string& name, const std::string& file, const std::string& target);

  /// Attributes of a group or dataset ("/" is the file itself). T: double, long long, std::string.
  template <typename T>
  void write_attribute(const std::string& object, const std::string& name, const T& value);
  template <typename T>
  T read_attribute(const std::string& object, const std::string& name) const;

  /// An attribute of any length, which is not for `read_attribute`: it is stored apart from its
  /// object, because HDF5 keeps 64 kB at most in one.
  void write_text_attribute(const std::string& object, const std::string& name,
                            const std::string& text);

  /// Text of any length as a scalar dataset; the text of rank 0 is written.
  void write_text(const std::string& name, const std::string& text);
  std::string read_text(const std::string& name) const;

  /// A table every rank could hold; the values of rank 0 are written, the others may pass none.
  /// values: row by row, n_components to a row; n_components = 1 makes a one-dimensional dataset.
  /// T: double, long long, int.
  template <typename T>
  void write_replicated(const std::string& name, const std::vector<T>& values, int n_components = 1,
                        Precision precision = Precision::double_precision);

  /// A table whose rows lie on the ranks one after another. T: double, long long.
  template <typename T>
  void write_slices(const std::string& name, const std::vector<T>& values, int n_components = 1);

  /// Cell values of a box [n_cells z][y][x] (and [3] if n_components > 1: missing components are 0)
  /// from blocks that no two ranks share. `values` holds the blocks one after another, x fastest
  /// within a block, components together. Cells in no block become 0.
  void write_box(const std::string& name, const std::array<int, 3>& n_cells, int n_components,
                 const std::vector<CellBlock>& blocks, const std::vector<double>& values,
                 const BoxStorage& storage = {});

  /// Extents of a dataset; empty for a scalar.
  std::vector<GlobalIndex> shape(const std::string& name) const;
  /// Rows [first_row, first_row + n_rows) of the first extent; each rank asks for its own.
  /// T: double, long long, int.
  template <typename T>
  std::vector<T> read_rows(const std::string& name, GlobalIndex first_row,
                           GlobalIndex n_rows) const;
  /// All rows, on every rank.
  template <typename T>
  std::vector<T> read_all(const std::string& name) const;

 private:
  Hdf5File(const Communicator& comm, const std::string& path, bool writing);
  void create_file();
  void open_file();
  /// Adds the structure and forces the numbers to disk; then `commit` gives the final name.
  void finish_part();
  void commit();
  void abandon() noexcept;
  /// The name in the whole file of what is called so below the group that was entered.
  std::string inside(const std::string& name) const;
  std::int64_t id() const { return writing_ ? structure_.id() : id_; }
  /// Throws on all ranks if any of them failed; `action` completes "Cannot ... in file".
  void agree(const std::string& failure, const std::string& action) const;
  /// Creates a scalar attribute of an HDF5 type (hid_t) with the value at `data`.
  void create_attribute(const std::string& object, const std::string& name, std::int64_t type,
                        const void* data);
  /// Creates a dataset and returns where in the file its values lie [bytes].
  template <typename T>
  GlobalIndex reserve(const std::string& name, const std::vector<GlobalIndex>& extents);
  /// Writes this rank's values, which begin at element `first` of the dataset at `offset`.
  template <typename T>
  void write_values(const std::string& name, GlobalIndex offset, GlobalIndex first,
                    const std::vector<T>& values);
  template <typename T>
  void write_compressed(const std::string& name, const std::vector<GlobalIndex>& extents,
                        const std::vector<T>& values, int level);
  template <typename T>
  void write_table(const std::string& name, const std::vector<T>& values, int n_components);
  template <typename T>
  void write_cells(const std::string& name, const std::vector<GlobalIndex>& extents,
                   GlobalIndex first, const std::vector<double>& values, int compression_level);

  Communicator comm_;
  std::string path_, group_;
  bool writing_ = false;
  std::int64_t id_ = -1;  // while reading: an hid_t, spelt out to keep hdf5.h out of this header
  hdf5::Structure structure_;  // while writing, on rank 0
  int descriptor_ = -1;        // descriptor of the part file, for this rank's numbers
};

}  // namespace lockstep
