#pragma once
#include <array>

namespace lockstep {

/// Weights of samples at -1, 0, 1 and 2 for a point at f in [0, 1]: Lagrange's cubic as the mean of
/// the parabolas through the first and through the last three (Neville), `share` of the latter.
template <typename Values>
std::array<Values, 4> cubic_weights(const Values& f, const Values& share) {
  const Values left = 1 - share, bend = 0.5 * f * (1 - f);
  return {-left * bend, left * (1 - f * f) + share * (0.5 * (1 - f) * (2 - f)),
          left * (0.5 * f * (1 + f)) + share * f * (2 - f), -share * bend};
}

/// The share of a cubic at f, or that of the parabola alone where the sample at -1 or 2 is missing.
inline double cubic_share(double f, bool has_first, bool has_last) {
  if (!has_first)
    return 1;
  return has_last ? (1 + f) / 3 : 0;
}

}  // namespace lockstep
