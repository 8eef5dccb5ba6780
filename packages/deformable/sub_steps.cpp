#include "deformable/sub_steps.hpp"

#include <algorithm>
#include <cmath>

#include "base/round_off.hpp"

namespace lockstep {

/// (1 - k/n)^2, the first one halved: a convex sequence, whose cosine sums are never negative.
double SubSteps::weight(int k) const {
  const double sum = n / 3.0 + 1 / (6.0 * n), rest = 1 - double(k) / n;
  return (k == 0 ? 0.5 : 1) * rest * rest / sum;
}

double longest_sub_stepped(double stable, int most) {
  return std::max(1.0, 0.5 * most) * stable;
}

SubSteps sub_steps_for(double dt, double stable, int most) {
  if (most <= 1 || dt <= stable)
    return {1, dt};
  const double wanted = std::ceil(2 * dt / stable * (1 - rounding::sums));
  const int n = static_cast<int>(std::min<double>(most, wanted));
  return {n, 2 * dt / n};
}

}  // namespace lockstep
