#include "output/checkpoint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_DefaultSerialComm.hpp>

#include <sys/stat.h>

#include <fstream>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/exchange.hpp"
#include "test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int n_entities = 10;

/// Entities 0, 3, 6, .. 27 dealt to the ranks in turn, backwards; values (id, 1/(id+1)).
void write_checkpoint(const Communicator& comm, const std::string& folder, long long step,
                      int keep = 10) {
  std::vector<GlobalIndex> ids;
  std::vector<double> values;
  for (GlobalIndex i = n_entities - 1; i >= 0; --i) {
    if (i % comm->getSize() != comm->getRank())
      continue;
    ids.push_back(3 * i);
    values.insert(values.end(), {3.0 * i, 1.0 / (3.0 * i + 1.0)});
  }
  CheckpointWriter writer(comm, folder, {step, 0.1 * step, "<ParameterList/>"});
  writer.write_distributed("fluid/pressure", ids, values, 2);
  writer.write_distributed("fluid/phase", ids, ids);
  writer.file().write_replicated<double>("pose", {1, 2, 3});
  writer.finish(keep);
}

void expect_all_entities(const Communicator& comm, const std::string& path) {
  const CheckpointReader reader(comm, path);
  EXPECT_EQ(reader.header().step, 12);
  EXPECT_EQ(reader.header().time, 0.1 * 12);
  EXPECT_EQ(reader.header().parameters, "<ParameterList/>");
  // Other owners than those that wrote, and number 3 on every rank.
  std::vector<GlobalIndex> wanted = {3};
  for (GlobalIndex i = 0; i < n_entities; ++i) {
    if (i / 4 % comm->getSize() == comm->getRank())
      wanted.push_back(3 * i);
  }
  const auto pressure = reader.read_distributed<double>("fluid/pressure", wanted, 2);
  ASSERT_EQ(pressure.size(), 2 * wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_EQ(pressure[2 * i], wanted[i]);
    EXPECT_EQ(pressure[2 * i + 1], 1.0 / (wanted[i] + 1.0));
  }
  EXPECT_EQ(reader.read_distributed<long long>("fluid/phase", wanted), wanted);
  EXPECT_THAT(reader.file().read_all<double>("pose"), ElementsAre(1, 2, 3));
}

/// Messages in pieces of three arrive as those sent at once; rank r sends 5 r + k numbers to rank
/// k.
TEST(Exchange, LongMessagesGoInPieces) {
  const Communicator comm = Tpetra::getDefaultComm();
  const int rank = comm->getRank(), n_ranks = comm->getSize();
  std::vector<std::vector<double>> outgoing(n_ranks);
  std::vector<double> expected;
  std::vector<GlobalIndex> expected_counts;
  for (int other = 0; other < n_ranks; ++other) {
    for (int k = 0; k < 5 * rank + other; ++k)
      outgoing[other].push_back(100 * rank + other + 0.01 * k);
    expected_counts.push_back(5 * other + rank);
    for (int k = 0; k < 5 * other + rank; ++k)
      expected.push_back(100 * other + rank + 0.01 * k);
  }
  for (const GlobalIndex longest : {1 << 30, 3}) {
    std::vector<GlobalIndex> counts;
    EXPECT_EQ(send_to_ranks(comm, outgoing, &counts, longest), expected);
    EXPECT_EQ(counts, expected_counts);
  }
}

TEST(Checkpoint, ReadsBackOnTheSameAndOnOtherRankCounts) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint");
  write_checkpoint(comm, folder, 12);
  expect_all_entities(comm, folder + "/checkpoint-000012.h5");

  const Communicator serial = Teuchos::rcp(new Teuchos::SerialComm<int>());
  if (is_root(comm))
    expect_all_entities(serial, folder + "/checkpoint-000012.h5");

  const std::string other = fresh_folder("checkpoint-serial");
  if (is_root(comm))
    write_checkpoint(serial, other, 12);
  comm->barrier();
  expect_all_entities(comm, other + "/checkpoint-000012.h5");
  // The content does not depend on the number of ranks.
  const auto stored = [&](const std::string& path) {
    return Hdf5File::open(comm, path + "/checkpoint-000012.h5")
        .read_all<double>("fluid/pressure/values");
  };
  EXPECT_EQ(stored(folder), stored(other));
}

TEST(Checkpoint, SaysWhatIsMissing) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint-missing");
  write_checkpoint(comm, folder, 12);
  const CheckpointReader reader(comm, folder + "/checkpoint-000012.h5");
  EXPECT_THAT(message_of<InputError>([&] { reader.read_distributed<double>("smoke", {}); }),
              HasSubstr("no array 'smoke'"));
  EXPECT_THAT(message_of<InputError>(
                  [&] { reader.read_distributed<double>("fluid/phase", {is_root(comm) ? 4 : 3}); }),
              HasSubstr("no entry number 4"));
  EXPECT_THAT(
      message_of<OutputError>([&] { reader.read_distributed<double>("fluid/pressure", {}, 3); }),
      AllOf(HasSubstr("'fluid/pressure' does not hold 3"), HasSubstr("an earlier one")));
  EXPECT_THAT(message_of<OutputError>([&] { reader.check(!is_root(comm), "senseless"); }),
              HasSubstr("(senseless)"));
  EXPECT_THAT(message_of<OutputError>([&] {
                CheckpointWriter writer(comm, folder, {});
                writer.write_distributed<double>("twice", {5, 5}, {1, 2});
              }),
              HasSubstr("number 5 twice"));
}

TEST(Checkpoint, KeepsTheLastOnes) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint-keep");
  write_checkpoint(comm, folder, 99);
  for (const long long step : {1, 2, 3}) {
    write_checkpoint(comm, folder, step, 2);
  }
  comm->barrier();
  const auto exists = [&](const char* step) {
    return std::filesystem::exists(folder + "/checkpoint-0000" + step + ".h5");
  };
  EXPECT_FALSE(exists("01"));
  EXPECT_TRUE(exists("02"));
  EXPECT_TRUE(exists("03"));
  EXPECT_TRUE(exists("99"));
  EXPECT_EQ(latest_checkpoint(folder), folder + "/checkpoint-000099.h5");
  comm->barrier();
  discard_checkpoints_after(comm, folder, 3);
  EXPECT_EQ(latest_checkpoint(folder), folder + "/checkpoint-000003.h5");
}

TEST(Checkpoint, RefusesDamagedAndForeignFiles) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint-bad");
  const std::string whole = folder + "/checkpoint-000012.h5";
  write_checkpoint(comm, folder, 12);
  Hdf5File foreign = Hdf5File::create(comm, folder + "/foreign.h5");
  foreign.close();
  Hdf5File newer = Hdf5File::create(comm, folder + "/newer.h5");
  newer.write_attribute<std::string>("/", "format", "Lockstep checkpoint");
  newer.write_attribute<long long>("/", "version", 99);
  newer.close();
  if (is_root(comm)) {
    const std::string bytes = read_whole_file(whole);
    std::ofstream(folder + "/cut.h5", std::ios::binary) << bytes.substr(0, bytes.size() - 100);
    std::ofstream(folder + "/stub.h5", std::ios::binary) << bytes.substr(0, 5);
    std::ofstream(folder + "/text.h5") << "<xml/>, no checkpoint";
  }
  comm->barrier();
  const auto open = [&](const char* name) {
    return [&, name] { CheckpointReader(comm, folder + "/" + name); };
  };
  EXPECT_THAT(message_of<OutputError>(open("cut.h5")), HasSubstr("cut.h5' is truncated"));
  EXPECT_THAT(message_of<OutputError>(open("stub.h5")), HasSubstr("stub.h5' is truncated"));
  EXPECT_THAT(message_of<InputError>(open("text.h5")), HasSubstr("no HDF5 file"));
  EXPECT_THAT(message_of<InputError>(open("none.h5")), HasSubstr("does not exist"));
  EXPECT_THAT(message_of<InputError>(open("foreign.h5")), HasSubstr("not a checkpoint"));
  EXPECT_THAT(message_of<InputError>(open("newer.h5")), HasSubstr("version 99"));
}

TEST(Checkpoint, FindsAnyFlippedByte) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint-flipped");
  write_checkpoint(comm, folder, 12);
  const std::string path = folder + "/checkpoint-000012.h5";
  const std::string bytes = read_whole_file(path);
  comm->barrier();
  EXPECT_NO_THROW(CheckpointReader(comm, path));
  const bool alone = comm->getSize() == 1;
  const std::size_t stride = alone ? 13 : 997, last_stride = alone ? 1 : 23;
  for (std::size_t place = 0;
       place<bytes.size(); place += place + 100> bytes.size() ? last_stride : stride) {
    if (is_root(comm)) {
      std::string damaged = bytes;
      damaged[place] = static_cast<char>(damaged[place] ^ (1 << (place % 8)));
      std::ofstream(path, std::ios::binary) << damaged;
    }
    comm->barrier();
    EXPECT_THAT(message_of<OutputError>([&] { CheckpointReader(comm, path); }),
                HasSubstr("is truncated or damaged"))
        << place;
    comm->barrier();
  }
}

TEST(Checkpoint, RefusesWhatIsNoFile) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("checkpoint-pipe");
  if (is_root(comm)) {
    ASSERT_EQ(mkfifo((folder + "/pipe.h5").c_str(), 0600), 0);
  }
  comm->barrier();
  EXPECT_THAT(message_of<InputError>([&] { CheckpointReader(comm, folder + "/pipe.h5"); }),
              HasSubstr("a pipe"));
  EXPECT_THAT(message_of<OutputError>([&] { Hdf5File::open(comm, folder + "/pipe.h5"); }),
              HasSubstr("a pipe"));
  EXPECT_THAT(message_of<InputError>([&] { CheckpointReader(comm, folder); }),
              HasSubstr("a folder"));
}

}  // namespace
}  // namespace lockstep::test
