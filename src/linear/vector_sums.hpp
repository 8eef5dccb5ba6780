#pragma once
#include <array>
#include <cstddef>
#include <numeric>

#include "linear/types.hpp"

namespace lockstep {

/// Sum of products, in lanes so that no addition waits for the one before it.
template <typename A, typename B>
double sum_of_products(const A* a, const B* b, std::ptrdiff_t n) {
  constexpr std::ptrdiff_t n_lanes = 16;
  std::array<double, n_lanes> sums{};
  std::ptrdiff_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
#pragma GCC ivdep
    for (std::ptrdiff_t lane = 0; lane < n_lanes; ++lane)
      sums[lane] += static_cast<double>(a[i + lane]) * static_cast<double>(b[i + lane]);
  }
  for (; i < n; ++i)
    sums[0] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// The sum of values likewise. Local.
double sum(const double* values, std::ptrdiff_t n);
/// x . y over all ranks, as fast as memory: Kokkos Kernels' adds one term at a time. Collective.
double dot(const Vector& x, const Vector& y);
/// The 2-norm likewise. Collective.
double norm(const Vector& x);
/// y += factor x; returns |x|. One pass over both. Collective.
double add_and_measure(double factor, const Vector& x, Vector& y);

}  // namespace lockstep
