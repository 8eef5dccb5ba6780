#include "output/schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <thread>

namespace lockstep::test {
namespace {

using ::testing::ElementsAre;

/// The steps, of n of length dt, with which something comes.
std::vector<int> due(Schedule schedule, double start, double dt, int n) {
  std::vector<int> steps;
  double time = start;
  for (int step = 1; step <= n; ++step) {
    time += dt;
    if (schedule.reach(time, dt))
      steps.push_back(step);
  }
  return steps;
}

TEST(Schedule, IntervalsThatAreNoMultiplesOfStepsDoNotDrift) {
  EXPECT_THAT(due({0, 0.025}, 0, 0.01, 11), ElementsAre(3, 5, 8, 10));
  EXPECT_THAT(due({-7, 0.025}, -7, 0.01, 11), ElementsAre(3, 5, 8, 10));
}

TEST(Schedule, TimesThatWereAddedUpReachTheirMultiples) {
  const std::vector<int> steps = due({0, 0.04}, 0, 0.01, 100000);  // the last is at 1000 s + 2e-8
  ASSERT_EQ(steps.size(), 25000u);
  for (std::size_t i = 0; i < steps.size(); ++i)
    ASSERT_EQ(steps[i], 4 * (i + 1));
}

TEST(Schedule, ComesWithEveryStepThatIsLonger) {
  EXPECT_THAT(due({0, 0}, 0, 0.01, 3), ElementsAre(1, 2, 3));
  EXPECT_THAT(due({0, 1e-300}, 0, 0.01, 3), ElementsAre(1, 2, 3));
  EXPECT_THAT(due({0, 0.007}, 0, 0.01, 5), ElementsAre(1, 2, 3, 4, 5));
}

TEST(Schedule, StepsOfAnyLengthReachAMultipleOnce) {
  Schedule schedule(0, 1);
  EXPECT_FALSE(schedule.reach(0.9, 0.9));
  EXPECT_TRUE(schedule.reach(1 - 1e-8, 0.1));
  EXPECT_FALSE(schedule.reach(1, 1e-8));
  EXPECT_FALSE(schedule.reach(1.5, 0.5));
  EXPECT_TRUE(schedule.reach(2.1, 0.6));
}

TEST(Schedule, GoesOnAfterARestart) {
  Schedule schedule(0, 0.025);
  schedule.reach(0.07, 0.01);
  EXPECT_THAT(due(schedule, 0.07, 0.01, 4), ElementsAre(1, 3));
}

TEST(WallClockSchedule, ComesOnceInAnInterval) {
  const Communicator comm = Tpetra::getDefaultComm();
  WallClockSchedule often(0.05), seldom(1000);
  EXPECT_FALSE(often.reach(comm));
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  EXPECT_TRUE(often.reach(comm));
  EXPECT_FALSE(often.reach(comm));
  EXPECT_FALSE(seldom.reach(comm));
}

}  // namespace
}  // namespace lockstep::test
