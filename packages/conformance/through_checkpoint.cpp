#include "conformance/through_checkpoint.hpp"

#include <cstdlib>
#include <filesystem>

#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "output/on_root.hpp"

namespace lockstep {

namespace fs = std::filesystem;

namespace {

/// A new folder that all ranks know, and that is gone with this object.
class ScratchFolder {
 public:
  explicit ScratchFolder(const Communicator& comm) : comm_(comm) {
    on_root(comm, [this] {
      path_ = (fs::temp_directory_path() / "lockstep-XXXXXX").string();
      check_output(mkdtemp(path_.data()) != nullptr, "Cannot create a folder in '{}'.",
                   fs::temp_directory_path().string());
    });
    int size = static_cast<int>(path_.size());
    MPI_Bcast(&size, 1, MPI_INT, 0, raw_communicator(comm));
    path_.resize(static_cast<std::size_t>(size));
    MPI_Bcast(path_.data(), size, MPI_CHAR, 0, raw_communicator(comm));
  }
  ~ScratchFolder() {
    std::error_code ignored;
    if (is_root(comm_))
      fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  Communicator comm_;
  std::string path_;
};

}  // namespace

void load_what_was_saved(PlugIn& plug_in, const Communicator& comm,
                         const std::function<void()>& change, Violations& found) {
  const ScratchFolder folder(comm);
  const char* doing = "save";
  try {
    {
      CheckpointWriter checkpoint(comm, folder.path(), {0, 0, "<ParameterList/>"});
      plug_in.save(checkpoint);
      checkpoint.finish(1);
    }
    change();
    doing = "load";
    plug_in.load(CheckpointReader(comm, folder.path() + "/checkpoint-000000.h5"));
  } catch (const Failure& failure) {
    found.push_back(fmt::format("{}: {}", doing, failure.what()));
  }
}

}  // namespace lockstep
