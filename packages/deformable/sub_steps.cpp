#include "deformable/sub_steps.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
constexpr double coverage = 2.5;
}

double longest_sub_stepped(double stable, int most) {
  return std::max(1.0, std::sqrt(most * (most + 1) / coverage)) * stable;
}

SubSteps sub_steps_for(double dt, double stable, int most) {
  if (most <= 1 || dt <= stable)
    return {1, dt};
  int n = 2;
  while (n < most && n * (n + 1) * stable * stable < coverage * dt * dt)
    ++n;
  return {n, dt * std::sqrt(coverage / (n * (n + 1)))};
}

}  // namespace lockstep
