#include "liquid/common/wet_fraction.hpp"

#include <algorithm>

namespace lockstep {

namespace {
/// The part of an edge from a wet end to a dry one that is wet.
double crossing(double wet, double dry) {
  return wet / (wet - dry);
}

/// Values at the corners, ascending.
double wet_part(const std::array<double, 3>& phi) {
  if (phi[0] >= 0)
    return 0;
  if (phi[1] >= 0)
    return crossing(phi[0], phi[1]) * crossing(phi[0], phi[2]);
  if (phi[2] >= 0)
    return 1 - (1 - crossing(phi[0], phi[2])) * (1 - crossing(phi[1], phi[2]));
  return 1;
}
double wet_part(const std::array<double, 4>& phi) {
  if (phi[0] >= 0)
    return 0;
  if (phi[1] >= 0)
    return crossing(phi[0], phi[1]) * crossing(phi[0], phi[2]) * crossing(phi[0], phi[3]);
  if (phi[2] >= 0) {
    // A wedge, as three tetrahedra.
    const double p = crossing(phi[0], phi[2]), q = crossing(phi[0], phi[3]);
    const double r = crossing(phi[1], phi[2]), s = crossing(phi[1], phi[3]);
    return p * q + (1 - p) * q * r + (1 - q) * r * s;
  }
  if (phi[3] >= 0)
    return 1 - (1 - crossing(phi[0], phi[3])) * (1 - crossing(phi[1], phi[3])) *
                   (1 - crossing(phi[2], phi[3]));
  return 1;
}

/// The simplices by their corners.
constexpr int paths_2[2][3] = {{0, 1, 3}, {0, 2, 3}};
constexpr int paths_3[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                               {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

template <int n, int m, std::size_t n_corners>
double mean_of(const int (&paths)[n][m], const std::array<double, n_corners>& phi) {
  double sum = 0;
  for (const auto& path : paths) {
    std::array<double, m> values;
    for (int k = 0; k < m; ++k)
      values[k] = phi[path[k]];
    std::sort(values.begin(), values.end());
    sum += wet_part(values);
  }
  return sum / n;
}
}  // namespace

template <int dim>
double wet_fraction(const std::array<double, 1 << dim>& phi) {
  if constexpr (dim == 2)
    return mean_of(paths_2, phi);
  else
    return mean_of(paths_3, phi);
}

template double wet_fraction<2>(const std::array<double, 4>&);
template double wet_fraction<3>(const std::array<double, 8>&);

}  // namespace lockstep
