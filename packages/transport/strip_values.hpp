#pragma once
#ifdef __AVX2__
#include <immintrin.h>
#endif
#include <array>
#include <type_traits>

#include "grid/strips.hpp"

namespace lockstep {

/// Positions of a strip of samples, by axis, relative to a block's first cell.
template <int dim>
using StripPoints = std::array<StripValues<dim>, dim>;

// Blends two strips. Always inlined: else strips go through memory, which takes twice the time of
// the arithmetic.
template <typename Values>
[[gnu::always_inline]] inline Values blend(const Values& a, const Values& b, const Values& weight) {
  return a + weight * (b - a);
}

/// 0, 1, 2, ...
template <int dim>
StripValues<dim> steps() {
  alignas(64) static constexpr double counted[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                   8, 9, 10, 11, 12, 13, 14, 15};
  static_assert(tile_width<dim> <= 16);
  return Eigen::Map<const StripValues<dim>>(counted);
}

/// One sample, or those of a whole row that are neighbours in memory.
template <typename Values>
Values samples_at(const double* c) {
  if constexpr (std::is_same_v<Values, double>)
    return *c;
  else
    return Eigen::Map<const Values>(c);
}

/// Returns the values at given places.
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

/// True if some value is not 0.
template <int n>
[[gnu::always_inline]] inline bool has_nonzero(const Eigen::Array<double, n, 1>& values) {
#ifdef __AVX512F__
  unsigned found = 0;
  for (int i = 0; i < n; i += 8)
    found |=
        _mm512_cmp_pd_mask(_mm512_loadu_pd(values.data() + i), _mm512_setzero_pd(), _CMP_NEQ_UQ);
  return found != 0;
#elif defined(__AVX2__)
  __m256d found = _mm256_setzero_pd();
  for (int i = 0; i < n; i += 4)
    found = _mm256_or_pd(
        found, _mm256_cmp_pd(_mm256_loadu_pd(values.data() + i), _mm256_setzero_pd(), _CMP_NEQ_UQ));
  return _mm256_movemask_pd(found) != 0;
#else
  return values.abs().sum() != 0;
#endif
}

/// A bit for each value that is 0 or more.
template <int n>
[[gnu::always_inline]] inline unsigned bits_of_non_negative(
    const Eigen::Array<double, n, 1>& values) {
  unsigned bits = 0;
#ifdef __AVX2__
  for (int i = 0; i < n; i += 4)
    bits |= static_cast<unsigned>(_mm256_movemask_pd(
                _mm256_cmp_pd(_mm256_loadu_pd(values.data() + i), _mm256_setzero_pd(), _CMP_GE_OQ)))
            << i;
#else
  for (int i = 0; i < n; ++i)
    bits |= static_cast<unsigned>(values[i] >= 0) << i;
#endif
  return bits;
}

/// Lesser and greater of each two values; the second if one is not a number. Written with
/// conditions they would take two instructions, one of them slow.
[[gnu::always_inline]] inline StripPart least_of(StripPart a, StripPart b) {
#ifdef __AVX512F__
  return _mm512_min_pd(a, b);
#elif defined(__AVX2__)
  return _mm256_min_pd(a, b);
#else
  return a < b ? a : b;
#endif
}
[[gnu::always_inline]] inline StripPart most_of(StripPart a, StripPart b) {
#ifdef __AVX512F__
  return _mm512_max_pd(a, b);
#elif defined(__AVX2__)
  return _mm256_max_pd(a, b);
#else
  return a > b ? a : b;
#endif
}

/// The values of f(part of each row, ...): one instruction each where f is one. Compilers make
/// jumps of a loop with a condition, and calls of what Eigen returns.
template <int n, typename Function, typename... Rows>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> by_parts(
    const Function& f, const Eigen::Array<double, n, 1>& first, const Rows&... others) {
  Eigen::Array<double, n, 1> result;
  for (int i = 0; i < n; i += strip_part_size)
    part_of(result, i) = f(part_of(first, i), part_of(others, i)...);
  return result;
}

/// Returns the first value where the flag is not 0, else the second.
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> chosen(
    const Eigen::Array<double, n, 1>& flag, const Eigen::Array<double, n, 1>& first,
    const Eigen::Array<double, n, 1>& second) {
  return by_parts([](StripPart f, StripPart a, StripPart b) -> StripPart { return f != 0 ? a : b; },
                  flag, first, second);
}
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> least(
    const Eigen::Array<double, n, 1>& a, const Eigen::Array<double, n, 1>& b) {
  return by_parts([](StripPart x, StripPart y) { return least_of(x, y); }, a, b);
}
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> most(const Eigen::Array<double, n, 1>& a,
                                                              const Eigen::Array<double, n, 1>& b) {
  return by_parts([](StripPart x, StripPart y) { return most_of(x, y); }, a, b);
}
/// The values, but none below `low` nor above `high`; what is not a number becomes `low`.
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> clamped(
    const Eigen::Array<double, n, 1>& values, double low, double high) {
  return by_parts(
      [low, high](StripPart x) -> StripPart {
        return least_of(most_of(x, low + StripPart{}), high + StripPart{});
      },
      values);
}

/// The values between `low` and `high`; where there is nothing between them the other one.
template <int n>
[[gnu::always_inline]] inline Eigen::Array<double, n, 1> within(
    const Eigen::Array<double, n, 1>& values, const Eigen::Array<double, n, 1>& low,
    const Eigen::Array<double, n, 1>& high, const Eigen::Array<double, n, 1>& otherwise) {
  return by_parts(
      [](StripPart x, StripPart lowest, StripPart highest, StripPart other) -> StripPart {
        return lowest <= highest ? least_of(most_of(x, lowest), highest) : other;
      },
      values, low, high, otherwise);
}

}  // namespace lockstep
