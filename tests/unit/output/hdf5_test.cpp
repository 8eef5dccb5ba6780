#include "output/hdf5_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Hdf5File, ReturnsWhatWasWritten) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path = fresh_folder("hdf5") + "/file.h5";
  const double rank = comm->getRank();
  {
    Hdf5File file = Hdf5File::create(comm, path);
    file.create_group("/a/b");
    file.write_attribute<double>("/a", "time", 0.1);
    file.write_attribute<long long>("/", "step", 1LL << 40);
    file.write_attribute<std::string>("/", "unit", "");
    file.write_text("xml", "<a/>\n");
    file.write_replicated<int>("/a/b/table", {1, 2, 3, 4, 5, 6}, 3);
    file.write_slices<double>("slices", {rank, -rank}, 2);
    file.write_slices<long long>("only_on_the_last", rank + 1 == comm->getSize()
                                                         ? std::vector<long long>{7}
                                                         : std::vector<long long>{});
    EXPECT_FALSE(std::filesystem::exists(path));
    file.close();
  }
  const Hdf5File file = Hdf5File::open(comm, path);
  EXPECT_EQ(file.read_attribute<double>("/a", "time"), 0.1);
  EXPECT_EQ(file.read_attribute<long long>("/", "step"), 1LL << 40);
  EXPECT_EQ(file.read_attribute<std::string>("/", "unit"), "");
  EXPECT_EQ(file.read_text("xml"), "<a/>\n");
  EXPECT_THAT(file.names("/"), ElementsAre("a", "only_on_the_last", "slices", "xml"));
  EXPECT_FALSE(file.exists("/x/y"));
  EXPECT_THAT(file.shape("/a/b/table"), ElementsAre(2, 3));
  EXPECT_THAT(file.read_rows<int>("/a/b/table", 1, 1), ElementsAre(4, 5, 6));
  EXPECT_THAT(file.read_rows<double>("slices", comm->getRank(), 1), ElementsAre(rank, -rank));
  EXPECT_THAT(file.read_all<long long>("only_on_the_last"), ElementsAre(7));
  EXPECT_THAT(message_of<OutputError>([&] { file.read_rows<int>("/a/b/table", 1, 2); }),
              HasSubstr("rows 1 to 3"));
}

TEST(Hdf5File, RefusesNumbersThatAreNotFinite) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path = fresh_folder("not-finite") + "/file.h5";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const bool last = comm->getRank() + 1 == comm->getSize();
  EXPECT_THAT(message_of<OutputError>([&] {
                Hdf5File::create(comm, path).write_slices<double>("v", {last ? nan : 1.0});
              }),
              HasSubstr("'v': it holds nan"));
  // Finite, but not in single precision.
  EXPECT_THROW(Hdf5File::create(comm, path)
                   .write_replicated<double>("v", {1e39}, 1, Precision::single_precision),
               OutputError);
  comm->barrier();
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(path).parent_path()));
}

TEST(Hdf5File, LeavesLinksAlone) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("links"), path = folder + "/file.h5";
  if (is_root(comm)) {
    std::ofstream(folder + "/precious") << "text";
    std::filesystem::create_symlink("precious", path + ".part");
  }
  comm->barrier();
  EXPECT_THAT(message_of<OutputError>([&] { Hdf5File::create(comm, path); }),
              HasSubstr("file.h5.part' is in the way"));
  EXPECT_THAT(message_of<OutputError>([&] { write_file_atomically(path, "other"); }),
              HasSubstr("file.h5.part' is in the way"));
  EXPECT_EQ(read_whole_file(folder + "/precious"), "text");
  comm->barrier();
  // Files that a killed run has left are no obstacle.
  if (is_root(comm)) {
    std::filesystem::remove(path + ".part");
    std::ofstream(path + ".part") << "half a file";
  }
  comm->barrier();
  EXPECT_NO_THROW(Hdf5File::create(comm, path).close());
}

TEST(Hdf5File, RefusesOtherKindsAndShapes) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path = fresh_folder("kinds") + "/file.h5";
  {
    Hdf5File file = Hdf5File::create(comm, path);
    file.write_attribute<std::string>("/", "name", "a name longer than a number");
    file.write_attribute<double>("/", "half", 0.5);
    file.write_replicated<double>("reals", {0.5});
    file.write_text("text", "some text");
    file.close();
  }
  const Hdf5File file = Hdf5File::open(comm, path);
  EXPECT_THROW(file.read_attribute<long long>("/", "name"), OutputError);
  EXPECT_THROW(file.read_attribute<long long>("/", "half"), OutputError);
  EXPECT_THROW(file.read_attribute<std::string>("/", "half"), OutputError);
  EXPECT_THROW(file.read_all<long long>("reals"), OutputError);
  EXPECT_THROW(file.read_all<double>("text"), OutputError);
  EXPECT_THROW(file.read_text("reals"), OutputError);
}

TEST(Hdf5File, RefusesOverlappingBlocks) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path = fresh_folder("overlap") + "/file.h5";
  std::vector<CellBlock> blocks;
  std::vector<double> values;
  if (is_root(comm)) {
    blocks = {{{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}};
    values = {1, 2, 3, 4};
  }
  EXPECT_THAT(message_of<OutputError>([&] {
                Hdf5File::create(comm, path).write_box("v", {3, 1, 1}, 1, blocks, values);
              }),
              HasSubstr("share a cell"));
}

TEST(Hdf5File, NamesTheFileThatCannotBeOpened) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path = fresh_folder("missing") + "/no/file.h5";
  for (const std::string& message :
       {message_of<OutputError>([&] { Hdf5File::open(comm, path); }),
        message_of<OutputError>([&] { Hdf5File::create(comm, path); })}) {
    EXPECT_THAT(message, HasSubstr(path));
    EXPECT_THAT(message, HasSubstr("No such file or directory"));
  }
}

/// Writes files of all sizes around the `capacity` [bytes] of a place, so that the data, the
/// structure or the closing fails; none may leave anything behind, and a small file must work
/// afterwards.
void expect_clean_failures(const std::string& folder, int capacity) {
  const Communicator comm = Tpetra::getDefaultComm();
  int n_failures = 0;
  for (int size = capacity / 8; size <= 2 * capacity; size += capacity / 8) {
    const std::vector<double> values(size / 8 / comm->getSize() / 4, 1.5);
    const std::string message = message_of<OutputError>([&] {
      Hdf5File file = Hdf5File::create(comm, folder + "/file.h5");
      for (const char* name : {"a", "b", "c", "d"}) {
        file.create_group(name);
        file.write_slices(std::string(name) + "/v", values);
      }
      file.write_text("text", std::string(1000, 'x'));
      file.close();
    });
    comm->barrier();
    EXPECT_FALSE(std::filesystem::exists(folder + "/file.h5.part"));
    EXPECT_EQ(std::filesystem::exists(folder + "/file.h5"), message.empty());
    if (!message.empty()) {
      ++n_failures;
      EXPECT_THAT(message, HasSubstr(folder + "/file.h5"));
    }
    comm->barrier();
    if (is_root(comm))
      std::filesystem::remove(folder + "/file.h5");
    comm->barrier();
  }
  EXPECT_GE(n_failures, 8);
  EXPECT_LE(n_failures, 12);
  Hdf5File file = Hdf5File::create(comm, folder + "/small.h5");
  file.write_slices<double>("v", {1.0});
  EXPECT_NO_THROW(file.close());
}

TEST(Hdf5File, SurvivesALimitOfTheFileSize) {
  const std::string folder = fresh_folder("limit");
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limited{4194304, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limited), 0);
  expect_clean_failures(folder, 4194304);
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
}

TEST(Hdf5File, SurvivesAFullDisk) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("full");
  const bool mine_failed =
      is_root(comm) && mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=256k") != 0;
  if (max_all(comm, static_cast<GlobalIndex>(mine_failed)) > 0) {
    GTEST_SKIP() << "a full disk needs the right to mount a small one";
  }
  expect_clean_failures(folder, 262144);
  comm->barrier();
  if (is_root(comm)) {
    EXPECT_EQ(umount(folder.c_str()), 0);
  }
}

}  // namespace
}  // namespace lockstep::test
