#pragma once
#ifdef __AVX512F__
#include <immintrin.h>
#endif
#include <array>
#include <type_traits>

#include "mac/state/rows.hpp"

namespace lockstep {

/// Positions of a row of samples, by axis, relative to a block's first cell.
template <int dim>
using RowPoints = std::array<RowValues<dim>, dim>;

// Not inlined, rows go through memory: twice the time of what is done with them.
template <typename Values>
[[gnu::always_inline]] inline Values blend(const Values& a, const Values& b, const Values& weight) {
  return a + weight * (b - a);
}

/// 0, 1, 2, ...
template <int dim>
RowValues<dim> steps() {
  alignas(64) static constexpr double counted[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                   8, 9, 10, 11, 12, 13, 14, 15};
  static_assert(tile_width<dim> <= 16);
  return Eigen::Map<const RowValues<dim>>(counted);
}

/// One sample, or those of a whole row that are neighbours in memory.
template <typename Values>
Values samples_at(const double* c) {
  if constexpr (std::is_same_v<Values, double>)
    return *c;
  else
    return Eigen::Map<const Values>(c);
}

/// Those at given places.
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> gathered(
    const double* c, const Eigen::Array<int, n, 1>& places) {
  Eigen::Array<double, n, 1> values;
  for (int i = 0; i < n; i += 8) {
#ifdef __AVX512F__
    const __m256i eight = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(places.data() + i));
    _mm512_storeu_pd(values.data() + i, _mm512_i32gather_pd(eight, c, sizeof(double)));
#else
    for (int k = i; k < i + 8; ++k)
      values[k] = c[places[k]];
#endif
  }
  return values;
}

/// Whether some value is not 0.
template <int n>
[[gnu::always_inline]] inline bool has_nonzero(const Eigen::Array<double, n, 1>& values) {
#ifdef __AVX512F__
  unsigned found = 0;
  for (int i = 0; i < n; i += 8)
    found |=
        _mm512_cmp_pd_mask(_mm512_loadu_pd(values.data() + i), _mm512_setzero_pd(), _CMP_NEQ_UQ);
  return found != 0;
#else
  return values.abs().sum() != 0;
#endif
}

/// Where the flag is not 0 the first, else the second.
template <int dim>
[[gnu::always_inline]] inline RowValues<dim> chosen(const RowValues<dim>& flag,
                                                    const RowValues<dim>& first,
                                                    const RowValues<dim>& second) {
  // Compilers make jumps of a loop with a condition.
  using Part [[gnu::vector_size(EIGEN_MAX_ALIGN_BYTES), gnu::may_alias]] = double;
  constexpr int n = EIGEN_MAX_ALIGN_BYTES / sizeof(double);
  RowValues<dim> result;
  for (int i = 0; i < tile_width<dim>; i += n) {
    const auto part = [i](const RowValues<dim>& values) -> const Part& {
      return *reinterpret_cast<const Part*>(values.data() + i);
    };
    *reinterpret_cast<Part*>(result.data() + i) = part(flag) != 0 ? part(first) : part(second);
  }
  return result;
}

}  // namespace lockstep
