#include "output/history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/csv_line.hpp"
#include "test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;

const std::vector<HistoryColumn> columns = {
    {"step", "1", "number of the step"}, {"time", "s", "end of the step"}, {"name", "1", "solid"}};
const std::string header =
    "# step [1]: number of the step\n# time [s]: end of the step\n# name [1]: solid\n"
    "step,time,name\n";
const std::string row_1 = "1,0.10000000000000001,\"a,b\"\n";
const std::string row_2 = "2,0.20000000000000001,c\n";

struct History : ::testing::Test {
  Communicator comm = Tpetra::getDefaultComm();
  std::string path = fresh_folder("history") + "/history.csv";

  void expect_content(const std::string& text) const {
    comm->barrier();
    EXPECT_EQ(read_whole_file(path), text);
    comm->barrier();
  }
};

TEST_F(History, WritesUnitsNamesAndExactNumbers) {
  HistoryTable table(comm, path, columns);
  table.start();
  table.append_row({1LL, 0.1, "a,b"});
  expect_content(header + row_1);
  table.append_row({2LL, 0.2, "c"});
  expect_content(header + row_1 + row_2);
}

TEST_F(History, SaysNanOfWhatMayBeUnknown) {
  HistoryTable table(comm, path, {{"step", "1", ""}, {"error", "1", "", true}});
  table.start();
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  table.append_row({1LL, unknown});
  expect_content("# step [1]: \n# error [1]: \nstep,error\n1,nan\n");
  EXPECT_THROW(table.append_row({2LL, std::numeric_limits<double>::infinity()}), OutputError);
}

TEST(CsvLine, GivesBackWhatWasWritten) {
  const std::vector<std::string> texts{"", "plain", "a,b", "he said \"no\", twice", "\"", "#1"};
  std::string line = csv_field(texts.front());
  for (std::size_t i = 1; i < texts.size(); ++i)
    line += "," + csv_field(texts[i]);
  EXPECT_EQ(csv_fields(line), texts);
}

TEST_F(History, ResumesATornTable) {
  if (is_root(comm))
    std::ofstream(path) << header + row_1 + row_2 + row_2 + "3,0.3,c\n4,0.4";
  comm->barrier();
  HistoryTable table(comm, path, columns);
  table.resume(3);
  expect_content(header + row_1 + row_2 + row_2 + "3,0.3,c\n");
  table.resume(1);
  expect_content(header + row_1);
  table.append_rows({{2LL, 0.2, "c"}});
  expect_content(header + row_1 + row_2);
}

TEST_F(History, RefusesOtherColumns) {
  if (is_root(comm))
    std::ofstream(path) << "step,x\n1,2\n";
  comm->barrier();
  HistoryTable table(comm, path, columns);
  EXPECT_THAT(message_of<InputError>([&] { table.resume(1); }), HasSubstr("other columns"));
  expect_content("step,x\n1,2\n");
}

TEST_F(History, RefusesNumbersThatAreNotFinite) {
  HistoryTable table(comm, path, columns);
  table.start();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of<OutputError>([&] {
                table.append_row({1LL, nan, "c"});
              }),
              HasSubstr("column 'time'"));
  expect_content(header);
}

TEST_F(History, KeepsWholeRowsWhenTheDiskIsFull) {
  HistoryTable table(comm, path, columns);
  table.start();
  table.append_row({1LL, 0.1, "a,b"});
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limited{header.size() + row_1.size() + 5, old.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limited), 0);
  const std::string message = message_of<OutputError>([&] { table.append_row({2LL, 0.2, "c"}); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_THAT(message, HasSubstr(path));
  expect_content(header + row_1);
  table.append_row({2LL, 0.2, "c"});
  expect_content(header + row_1 + row_2);
}

}  // namespace
}  // namespace lockstep::test
