// Surroundings of a run: progress, banner, timers, signals and the record of its input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "base/errors.hpp"
#include "base/signals.hpp"
#include "output/progress.hpp"
#include "output/provenance/build_information.hpp"
#include "output/run_record.hpp"
#include "output/timers.hpp"
#include "test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

TEST(Progress, IsOneLineAStep) {
  StepProgress progress;
  progress.step = 120;
  progress.time = 1.2;
  progress.time_step = 0.01;
  progress.cfl = 0.84;
  progress.iterations = {{"S1", 34}, {"F2", 21}, {"S2", 33}};
  progress.max_divergence = 3.1e-9;
  progress.momentum_error = 2e-15;
  progress.wall_seconds = 0.41;
  progress.remaining_seconds = 190;
  EXPECT_EQ(progress_line(progress),
            "step   120  t 1.200 s  dt 10.00 ms  CFL 0.84  S1 34  F2 21  S2 33 it  |div| 3e-9  "
            "dP 2e-15  0.41 s  eta 3m10s");
  progress.bound = "surface tension";
  EXPECT_THAT(progress_line(progress), HasSubstr("  dt 10.00 ms (surface tension)  CFL 0.84"));
}

TEST(Progress, EstimatesTheRemainingTime) {
  EXPECT_DOUBLE_EQ(remaining_seconds(30, 0, 0.25), 90);
  EXPECT_LT(remaining_seconds(1, 0, 0), 0);
  EXPECT_NEAR(remaining_seconds(10, 0.9, 0.901), 990, 1e-9) << "of a run continued at 90 %";
  EXPECT_EQ(format_duration(59.4), "59s");
  EXPECT_EQ(format_duration(7500), "2h05m");
  EXPECT_EQ(format_duration(100 * 3600), "4d04h");
  EXPECT_EQ(format_seconds(0), "0.000 s");
  EXPECT_EQ(format_seconds(0.00099999), "1.000 ms");
}

TEST(Log, ObeysTheLevelOnRankZero) {
  const Communicator comm = Tpetra::getDefaultComm();
  std::ostringstream text;
  const Log log(comm, text, LogLevel::normal);
  log.normal("{} dofs", 3);
  log.debug("hidden");
  log.warning("heavy");
  EXPECT_EQ(text.str(), is_root(comm) ? "3 dofs\nwarning: heavy\n" : "");
}

TEST(Banner, NamesTheBuild) {
  const Communicator comm = Tpetra::getDefaultComm();
  EXPECT_THAT(banner(comm, "simulate scene.xml"),
              MatchesRegex("Lockstep [0-9.]+ \\([^)]+\\), [A-Za-z]* build, GNU [0-9.]+\n"
                           "Trilinos [^,]+, Open MPI [^,]+, HDF5 1\\.[0-9.]+\n"
                           "[0-9]+ ranks?, 20[0-9-]+ [0-9:]+ UTC\n"
                           "simulate scene.xml"));
}

TEST(StageTimers, NestAndReduceOverTheRanks) {
  const Communicator comm = Tpetra::getDefaultComm();
  StageTimers timers;
  for (int i = 0; i < 2; ++i) {
    const ScopedStage step(timers, "step");
    const ScopedStage solve(timers, "S2 solve");
    // The last rank takes longest.
    if (comm->getRank() + 1 == comm->getSize()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  const std::vector<StageTime> report = timers.report(comm);
  ASSERT_EQ(report.size(), 2u);
  EXPECT_EQ(report[0].name, "step");
  EXPECT_EQ(report[1].name, "step / S2 solve");
  EXPECT_EQ(report[1].calls, 2);
  EXPECT_GE(report[1].max_seconds, 0.02);
  EXPECT_GE(report[0].max_seconds, report[1].max_seconds);
  EXPECT_GE(report[1].mean_seconds * comm->getSize(), 0.02);
  EXPECT_LE(report[1].mean_seconds, report[1].max_seconds);
  if (comm->getSize() > 1) {
    EXPECT_LT(report[1].min_seconds, 0.02);
  }
  EXPECT_THAT(timing_table(report), HasSubstr("\nstep / S2 solve         2  "));
  const PeakMemory memory = peak_memory_mb(comm);
  EXPECT_GT(memory.largest_rank_mb, 1);
  EXPECT_GE(memory.all_ranks_mb, memory.largest_rank_mb);
}

TEST(CpuSeconds, PassWhileAProcessWorksAndNotWhileItSleeps) {
  const double start = cpu_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const double slept = cpu_seconds();
  EXPECT_LT(slept - start, 0.05);
  while (cpu_seconds() < slept + 0.05) {
  }
}

TEST(Signals, AreSeenByAllRanks) {
  const Communicator comm = Tpetra::getDefaultComm();
  install_signal_handlers();
  EXPECT_EQ(signal_received(comm), 0);
  if (comm->getRank() + 1 == comm->getSize())
    std::raise(SIGTERM);
  EXPECT_EQ(signal_received(comm), SIGTERM);
  note_signal(0);
  EXPECT_EQ(signal_received(comm), 0);
}

TEST(RunRecord, KeepsTheInputByteForByte) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("record") + "/new/folder";
  create_output_directory(comm, folder);
  const std::string scene = folder + "/scene.xml";
  if (is_root(comm))
    std::ofstream(scene, std::ios::binary) << "<a>\r\n</a> ";
  record_input(comm, folder, scene, "<used/>");
  write_summary(comm, folder, {{"ranks", comm->getSize()}, {"a", 1}});
  EXPECT_EQ(read_whole_file(folder + "/input.xml"), "<a>\r\n</a> ");
  EXPECT_EQ(read_whole_file(folder + "/used-parameters.xml"), "<used/>");
  EXPECT_EQ(nlohmann::json::parse(read_whole_file(folder + "/summary.json"))["ranks"],
            comm->getSize());

  EXPECT_THAT(message_of<InputError>([&] { create_output_directory(comm, scene); }),
              HasSubstr("is a file"));
  EXPECT_THAT(message_of<InputError>([&] { create_output_directory(comm, scene + "/below"); }),
              HasSubstr("Choose another --output"));
  EXPECT_THAT(message_of<InputError>([&] { create_output_directory(comm, "/proc/1/output"); }),
              HasSubstr("/proc/1/output"));
  comm->barrier();
  EXPECT_THROW(write_file_atomically(folder + "/none/file", "text"), OutputError);
}

}  // namespace
}  // namespace lockstep::test
