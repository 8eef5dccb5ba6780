#pragma once
#include <chrono>

#include "base/communicator.hpp"

namespace lockstep {

/// When something comes that is written once in an interval of simulated time: with the first step
/// that ends at or past start + n interval, for n = 1, 2, ... So intervals that are no multiples of
/// steps do not drift, and a run that was restarted keeps to the times of the straight one.
class Schedule {
 public:
  /// `start` and `interval` in [s]; an interval of 0: every step.
  Schedule(double start, double interval) : start_(start), interval_(interval) {}
  /// After each step in turn, of `dt` up to `time` [s]: whether something comes now. After a
  /// restart once for the last step before it.
  bool reach(double time, double dt);

 private:
  double start_, interval_;
  double n_reached_ = 0;  ///< intervals until now, whole
};

/// When something comes that is written once in an interval of wall time, from the start on.
class WallClockSchedule {
 public:
  explicit WallClockSchedule(double interval) : interval_(interval) {}  ///< [s]
  /// Whether it comes now; then the next one comes an interval later. By the clock of rank 0.
  /// Collective.
  bool reach(const Communicator& comm);

 private:
  using Clock = std::chrono::steady_clock;
  double interval_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace lockstep
