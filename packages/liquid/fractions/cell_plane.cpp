#include "liquid/fractions/cell_plane.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Components of a normal below this count as zero: their fractions would be lost to round-off.
constexpr double flat = 1e-6;

/// Absolute components, ascending, with the sum 1 and none of them tiny; 2D has a leading zero.
using Slopes = std::array<double, 3>;

template <int dim>
Slopes slopes_of(const Point<dim>& normal) {
  Slopes m{};
  for (int a = 0; a < dim; ++a)
    m[a] = std::abs(normal[a]);
  std::sort(m.begin(), m.end());
  const double sum = m[0] + m[1] + m[2];
  double kept = 0;
  for (double& component : m) {
    component = component < flat * sum ? 0 : component;
    kept += component;
  }
  for (double& component : m)
    component /= kept;
  return m;
}

/// The part of the cell where m . x < alpha <= 1/2 (Scardovelli & Zaleski 2000).
double part_below(const Slopes& m, double alpha) {
  const auto [m1, m2, m3] = m;
  if (alpha <= 0)
    return 0;
  if (m2 == 0)
    return alpha;
  if (m1 == 0)
    return alpha < m2 ? alpha * alpha / (2 * m2 * m3) : (alpha - 0.5 * m2) / m3;
  if (alpha < m1)
    return alpha * alpha * alpha / (6 * m1 * m2 * m3);
  if (alpha < m2)
    return (3 * alpha * (alpha - m1) + m1 * m1) / (6 * m2 * m3);
  const double m12 = m1 + m2;
  if (m12 <= m3 && alpha >= m12)
    return (alpha - 0.5 * m12) / m3;
  double sum =
      alpha * alpha * (3 * m12 - alpha) + m1 * m1 * (m1 - 3 * alpha) + m2 * m2 * (m2 - 3 * alpha);
  if (alpha > m3)
    sum -= (alpha - m3) * (alpha - m3) * (alpha - m3);
  return sum / (6 * m1 * m2 * m3);
}

/// The inverse, for parts up to 1/2.
double constant_of(const Slopes& m, double part) {
  const auto [m1, m2, m3] = m;
  if (m2 == 0)
    return part;
  if (m1 == 0)
    return part < m2 / (2 * m3) ? std::sqrt(2 * m2 * m3 * part) : m3 * part + 0.5 * m2;
  if (part < m1 * m1 / (6 * m2 * m3))
    return std::cbrt(6 * m1 * m2 * m3 * part);
  const double m12 = m1 + m2;
  if (part < (3 * m2 * (m2 - m1) + m1 * m1) / (6 * m2 * m3))
    return 0.5 * (m1 + std::sqrt(std::max(m1 * m1 - 4 * (m1 * m1 / 3 - 2 * m2 * m3 * part), 0.0)));
  if (m12 <= m3 && m3 * part + 0.5 * m12 >= m12)
    return m3 * part + 0.5 * m12;
  // The rest is a cubic that rises steadily.
  double low = m2, high = std::min(0.5, std::max(m12, m3));
  for (int i = 0; i < 60 && high - low > 1e-16; ++i) {
    const double middle = 0.5 * (low + high);
    (part_below(m, middle) < part ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
}  // namespace

template <int dim>
double fraction_below(const CellPlane<dim>& plane) {
  double constant = plane.constant, sum = 0;
  for (int a = 0; a < dim; ++a) {
    constant += std::max(-plane.normal[a], 0.0);
    sum += std::abs(plane.normal[a]);
  }
  constant /= sum;
  const Slopes m = slopes_of<dim>(plane.normal);
  return constant <= 0.5   ? part_below(m, constant)
         : constant >= 1.0 ? 1.0
                           : 1 - part_below(m, 1 - constant);
}

template <int dim>
CellPlane<dim> plane_of_fraction(const Point<dim>& normal, double fraction) {
  CellPlane<dim> plane;
  const double sum = normal.template lpNorm<1>();
  for (int a = 0; a < dim; ++a)
    plane.normal[a] = std::abs(normal[a]) < flat * sum ? 0 : normal[a];
  plane.normal /= plane.normal.template lpNorm<1>();
  const Slopes m = slopes_of<dim>(plane.normal);
  plane.constant = fraction <= 0.5 ? constant_of(m, fraction) : 1 - constant_of(m, 1 - fraction);
  for (int a = 0; a < dim; ++a)
    plane.constant += std::min(plane.normal[a], 0.0);
  return plane;
}

template <int dim>
double liquid_in_slab(const CellPlane<dim>& plane, int axis, int side, double width) {
  CellPlane<dim> stretched = plane;
  stretched.constant -= side == 0 ? 0 : plane.normal[axis] * (1 - width);
  stretched.normal[axis] *= width;
  if (stretched.normal.template lpNorm<1>() < 1e-14)
    return stretched.constant > 0 ? width : 0;
  return width * fraction_below(stretched);
}

template double fraction_below<2>(const CellPlane<2>&);
template double fraction_below<3>(const CellPlane<3>&);
template CellPlane<2> plane_of_fraction<2>(const Point<2>&, double);
template CellPlane<3> plane_of_fraction<3>(const Point<3>&, double);
template double liquid_in_slab<2>(const CellPlane<2>&, int, int, double);
template double liquid_in_slab<3>(const CellPlane<3>&, int, int, double);

}  // namespace lockstep
