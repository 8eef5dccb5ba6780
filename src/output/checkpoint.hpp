#pragma once
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "output/hdf5_file.hpp"

namespace lockstep {

/// Properties that every checkpoint says about itself.
struct CheckpointHeader {
  long long step = 0;
  double time = 0;         ///< [s]
  std::string parameters;  ///< the complete parameter list of the run, as XML
  std::string files{};     ///< checksums of the files that the scene reads
};

/// Writes DIRECTORY/checkpoint-000123.h5, named after the step, with a checksum of the whole file.
/// The content does not depend on the number of ranks. All member functions are collective and
/// throw OutputError.
class CheckpointWriter {
 public:
  CheckpointWriter(const Communicator& comm, const std::string& directory,
                   const CheckpointHeader& header);

  /// For groups, attributes and tables that every rank holds.
  Hdf5File& file() { return file_; }

  /// Values that live on entities with a global number >= 0, each held by exactly one rank; stored
  /// in the order of the numbers. values: n_components for each entry of global_ids, kept together.
  /// T: double (kept bit for bit), long long.
  template <typename T>
  void write_distributed(const std::string& name, const std::vector<GlobalIndex>& global_ids,
                         const std::vector<T>& values, int n_components = 1);

  /// Gives the file its final name, then removes all but the last `keep` checkpoints up to this
  /// step.
  void finish(int keep);

 private:
  Communicator comm_;
  std::string directory_;
  long long step_;
  Hdf5File file_;
};

/// Reads a checkpoint on any number of ranks. All member functions are collective.
class CheckpointReader {
 public:
  /// Throws InputError if the file does not exist, is no checkpoint of this program or has another
  /// version; OutputError if it is truncated, if any of its bytes has changed, or if it cannot be
  /// read.
  CheckpointReader(const Communicator& comm, const std::string& path);

  const CheckpointHeader& header() const { return header_; }
  const Hdf5File& file() const { return file_; }
  Hdf5File& file() { return file_; }

  /// The values of these entities, in the order asked for; an entity may be asked for by several
  /// ranks. Throws InputError if the checkpoint lacks the array or one of the numbers, OutputError
  /// if the array has not so many components.
  template <typename T>
  std::vector<T> read_distributed(const std::string& name,
                                  const std::vector<GlobalIndex>& wanted_global_ids,
                                  int n_components = 1) const;
  /// Throws OutputError with `what` is wrong unless the content makes sense on all ranks: the bytes
  /// may be those that were written and be nonsense all the same.
  void check(bool makes_sense, const std::string& what) const;

 private:
  Communicator comm_;
  Hdf5File file_;
  CheckpointHeader header_;
};

/// Path of the checkpoint with the highest step in the folder, or "" if there is none. Not
/// collective.
std::string latest_checkpoint(const std::string& directory);

/// Collective: removes the checkpoints later than `step`, which a restarted run makes obsolete. A
/// new run passes -1.
void discard_checkpoints_after(const Communicator& comm, const std::string& directory,
                               long long step);

}  // namespace lockstep
