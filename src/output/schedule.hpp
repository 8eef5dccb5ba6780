#pragma once

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

}  // namespace lockstep
