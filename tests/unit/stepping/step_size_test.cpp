// Sizes of steps.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "conformance/fake_fluid.hpp"
#include "stepping/step_size.hpp"

namespace lockstep::test {
namespace {

TimeOptions until(double end) {
  TimeOptions time;
  time.end = end;
  time.largest_step = 0.1;
  return time;
}

}  // namespace

TEST(StepSize, NothingPassesMoreCellsThanTheCflNumber) {
  FakeBox<2> box;
  box.n_cells = {2, 2};
  box.spacing = 0.02;
  const FakeFluid<2> resting(box, Tpetra::getDefaultComm());
  EXPECT_EQ(wanted_step(until(10), resting.suggested_step(0.5, 0)).dt, 0.1);
  EXPECT_DOUBLE_EQ(wanted_step(until(10), resting.suggested_step(0.5, 2)).dt, 0.005);
  // The velocity that gravity adds within the step counts as well.
  box.gravity = {0, -14};
  FakeFluid<2> fluid(box, Tpetra::getDefaultComm());
  double dt = fluid.suggested_step(0.5, 0);
  EXPECT_DOUBLE_EQ(14 * dt * dt, 0.01);
  fluid.set_velocity([](int axis, const Point<2>&) { return axis == 0 ? 0.6 : 0; });
  dt = fluid.suggested_step(0.5, 0.2);
  EXPECT_DOUBLE_EQ(0.6 * dt + 14 * dt * dt, 0.01);
}

TEST(StepSize, AFixedStepIsTaken) {
  TimeOptions time = until(10);
  time.fixed_step = 0.25;
  EXPECT_EQ(wanted_step(time, 1e-6).dt, 0.25);
}

TEST(StepSize, FixedStepsDivideTheTimeEvenly) {
  TimeOptions time = until(1);
  EXPECT_EQ(even_step(time), 0);
  time.fixed_step = 0.25;
  EXPECT_EQ(even_step(time), 0.25);
  time.fixed_step = 0.3;
  EXPECT_DOUBLE_EQ(even_step(time), 0.25);
  time.fixed_step = 1. / 3;  // no fourth step for a last bit
  EXPECT_EQ(even_step(time), 1. / 3);
  time.fixed_step = 7;
  EXPECT_EQ(even_step(time), 1);
  // A number of steps that does not get there keeps the step.
  time.fixed_step = 0.3;
  time.most_steps = 3;
  EXPECT_EQ(even_step(time), 0.3);
  time.most_steps = 4;
  EXPECT_DOUBLE_EQ(even_step(time), 0.25);
}

TEST(StepSize, TheLastStepsEndAtTheEnd) {
  TimeOptions time = until(1);
  EXPECT_EQ(step_to_end(time, 0, 0.1), 0.1);
  EXPECT_DOUBLE_EQ(step_to_end(time, 0.85, 0.1), 0.075);  // the last two share what is left
  EXPECT_EQ(step_to_end(time, 0.95, 0.1), 1 - 0.95);
  EXPECT_EQ(step_to_end(time, 0.9, 0.1 * (1 - 1e-12)), 1 - 0.9);  // no step of round-off
  time.fixed_step = 0.1;
  EXPECT_EQ(step_to_end(time, 0.8, 0.1), 0.1);
  EXPECT_EQ(step_to_end(time, 0.9 + 1e-12, 0.1), 1 - (0.9 + 1e-12));
  // Fixed steps after some that had to be shorter.
  EXPECT_DOUBLE_EQ(step_to_end(time, 0.85, 0.1), 0.075);
  EXPECT_EQ(step_to_end(time, 0.95, 0.1), 1 - 0.95);
}

TEST(StepSize, SaysWhatBoundsIt) {
  TimeOptions time = until(10);
  EXPECT_EQ(wanted_step(time, 1e-6).reason, "");  // the CFL number
  EXPECT_EQ(wanted_step(time, 1).reason, "Largest Step");
  EXPECT_EQ(shorter(wanted_step(time, 1), {1e-3, "gravity waves"}).reason, "gravity waves");
  time.fixed_step = 0.25;
  EXPECT_EQ(wanted_step(time, 1e-6).reason, "Fixed Step");
}

TEST(StepSize, IsAPartOfTheRunByTimeOrBySteps) {
  TimeOptions time = until(10);
  EXPECT_DOUBLE_EQ(part_of_run(time, 2.5, 7), 0.25);
  time.most_steps = 20;
  EXPECT_DOUBLE_EQ(part_of_run(time, 2.5, 7), 0.35);
  EXPECT_DOUBLE_EQ(part_of_run(time, 5, 7), 0.5);
}

TEST(StepSize, ManyFixedStepsAddedUpTakeNoStepMore) {
  TimeOptions time = until(12);
  time.fixed_step = 1e-3;
  int n_steps = 0;
  double now = 0, dt = 0;
  for (; now < time.end; ++n_steps) {
    dt = step_to_end(time, now, time.fixed_step);
    now += dt;
  }
  EXPECT_EQ(n_steps, 12000);
  EXPECT_NEAR(dt, 1e-3, 1e-9);
}

}  // namespace lockstep::test
