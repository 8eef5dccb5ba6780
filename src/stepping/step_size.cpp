#include "stepping/step_size.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

double part_of_run(const TimeOptions& options, double time, long long steps) {
  const double by_time = time / (options.end - options.start);
  const double by_steps = options.most_steps > 0 ? double(steps) / double(options.most_steps) : 0;
  return std::max(by_time, by_steps);
}

double even_step(const TimeOptions& time) {
  const double length = time.end - time.start;
  if (time.fixed_step == 0 || (time.most_steps > 0 && time.most_steps * time.fixed_step < length))
    return time.fixed_step;
  const double n_steps = std::ceil(length / time.fixed_step * (1 - 1e-9));
  const double step = length / std::max(n_steps, 1.0);
  return std::abs(step - time.fixed_step) < 1e-9 * time.fixed_step ? time.fixed_step : step;
}

StepBound wanted_step(const TimeOptions& time, double suggested) {
  if (time.fixed_step > 0)
    return {time.fixed_step, "Fixed Step"};
  return shorter({suggested}, {time.largest_step, "Largest Step"});
}

double step_to_end(const TimeOptions& time, double now, double wanted) {
  constexpr double drift = 1e-6;  // error of times added up 1e5 times and more, over a step [1]
  const double left = time.end - now;
  if (left <= wanted * (1 + drift))
    return left;
  return left < 2 * wanted * (1 - drift) ? left / 2 : wanted;
}

}  // namespace lockstep
