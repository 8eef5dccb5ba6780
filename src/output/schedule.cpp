#include "output/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

bool Schedule::reach(double time, double dt) {
  if (interval_ == 0)
    return true;
  constexpr double drift = 1e-6;  // error of times that are added up, in steps [1]
  const double n = std::floor((time - start_ + drift * dt) / interval_);
  const bool is_another = n > n_reached_;
  n_reached_ = std::max(n, n_reached_);
  return is_another || interval_ <= dt;
}

bool WallClockSchedule::reach(const Communicator& comm) {
  const Clock::time_point now = Clock::now();
  const bool is_due =
      is_root(comm) && std::chrono::duration<double>(now - last_).count() >= interval_;
  if (max_all(comm, static_cast<GlobalIndex>(is_due)) == 0)
    return false;
  last_ = now;
  return true;
}

}  // namespace lockstep
