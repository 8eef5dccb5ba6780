#include "studies/status_line.hpp"

#include <gmock/gmock.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace lockstep::test {

using testing::HasSubstr;

TEST(StatusLine, TheLastWholeLineOfALogCounts) {
  EXPECT_EQ(state_of_run(""), "starting");
  EXPECT_EQ(state_of_run("Lockstep 0.1.0\n  Time/Steps = 3\n"), "starting");
  const std::string log =
      "banner\nstep     1  t 10.00 ms  dt 10.00 ms  CFL 0.84  0.41 s  eta 3m10s\n"
      "step    12  t 1.200 s  dt 10.00 ms  CFL 0.84  0.41 s  eta 48s\n";
  EXPECT_EQ(state_of_run(log), "step 12, eta 48s");
  EXPECT_EQ(state_of_run(log + "warning: something\nstep    13  t 1.2"), "step 12, eta 48s");
}

TEST(StatusLine, WithoutATerminalOnlyWhatHasEndedIsSaid) {
  std::ostringstream said, errors;
  StatusLine status(said, errors, 2, 0);
  status.started("a/n=4", "no such file");
  EXPECT_EQ(said.str(), "");
  status.ended("a/n=4", "done in 1 s", false);
  status.ended("a/n=8", "failed", true);
  EXPECT_EQ(said.str(), "[1/2] a/n=4: done in 1 s\n");
  EXPECT_EQ(errors.str(), "[2/2] a/n=8: failed\n");
}

TEST(StatusLine, OnATerminalWhatRunsIsNamedWithinItsWidth) {
  const std::string log = "status-line-test.log";
  std::ofstream(log) << "step     7  t 1.000 s  dt 10.00 ms  0.41 s  eta 48s\n";
  std::ostringstream said, errors;
  {
    StatusLine status(said, errors, 3, 50);
    status.started("b/n=4", log);
    EXPECT_THAT(said.str(), HasSubstr("0 of 3 after 0s; b/n=4 (step 7, eta 48s)"));
    status.started("a/n=4", "none");
    const std::string last = said.str().substr(said.str().rfind('\r'));
    EXPECT_EQ(last.size(), 49 + std::string("\r\033[K").size());
    EXPECT_THAT(last, HasSubstr("a/n=4 (starting), b/n=4 (step 7"));
    status.ended("b/n=4", "done", false);
    EXPECT_THAT(said.str(), HasSubstr("\r\033[K[1/3] b/n=4: done\n"));
  }
  EXPECT_THAT(said.str(), testing::EndsWith("\r\033[K"));
  std::remove(log.c_str());
}

}  // namespace lockstep::test
