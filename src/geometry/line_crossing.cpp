#include "geometry/line_crossing.hpp"

#include <algorithm>
#include <utility>

namespace lockstep {

namespace {

/// Crossing of an edge low -> high with the level `v` of its second coordinate, low.v <= v <
/// high.v.
struct EdgeCrossing {
  double u = 0;       ///< first coordinate
  double weight = 0;  ///< weight of the high end
};

/// Not inlined: both neighbours of an edge must execute the very same instructions, or a fused
/// multiply-add in one of them breaks the tie differently.
[[gnu::noinline]] EdgeCrossing cross_edge(double u_low, double v_low, double u_high, double v_high,
                                          double v) {
  const double weight = (v - v_low) / (v_high - v_low);
  const double u = u_low + weight * (u_high - u_low);
  const auto [least, most] = std::minmax(u_low, u_high);
  return {std::clamp(u, least, most), weight};
}

double coordinate_at(const double* coordinates, const double* weights, int n) {
  double value = 0, least = coordinates[0], most = coordinates[0];
  for (int k = 0; k < n; ++k) {
    value += weights[k] * coordinates[k];
    least = std::min(least, coordinates[k]);
    most = std::max(most, coordinates[k]);
  }
  return std::clamp(value, least, most);
}

bool cross_segment(const std::array<Point<2>, 2>& corners, int axis, const Point<2>& x,
                   Crossing<2>& crossing) {
  const int transverse = 1 - axis;
  const double v = x[transverse];
  const bool up = corners[0][transverse] <= v;
  if (up == (corners[1][transverse] <= v))
    return false;
  const int low = up ? 0 : 1, high = 1 - low;
  const EdgeCrossing edge = cross_edge(corners[low][axis], corners[low][transverse],
                                       corners[high][axis], corners[high][transverse], v);
  crossing.barycentric[low] = 1 - edge.weight;
  crossing.barycentric[high] = edge.weight;
  crossing.coordinate = edge.u;
  crossing.entering = up == (axis == 1);
  return true;
}

bool cross_triangle(const std::array<Point<3>, 3>& corners, int axis, const Point<3>& x,
                    Crossing<3>& crossing) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool low[3] = {corners[0][v] <= x[v], corners[1][v] <= x[v], corners[2][v] <= x[v]};
  if (low[0] == low[1] && low[1] == low[2])
    return false;

  // Exactly two edges cross the level x[v]: one on the way up, one on the way down.
  EdgeCrossing up, down;
  int up_low = 0, up_high = 0, down_low = 0, down_high = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (low[k] == low[next])
      continue;
    const int p = low[k] ? k : next, q = low[k] ? next : k;
    const EdgeCrossing edge =
        cross_edge(corners[p][u], corners[p][v], corners[q][u], corners[q][v], x[v]);
    (low[k] ? up : down) = edge;
    (low[k] ? up_low : down_low) = p;
    (low[k] ? up_high : down_high) = q;
  }
  if ((x[u] < up.u) == (x[u] < down.u))
    return false;

  const double toward_down = std::clamp((x[u] - up.u) / (down.u - up.u), 0.0, 1.0);
  crossing.barycentric.setZero();
  crossing.barycentric[up_low] += (1 - toward_down) * (1 - up.weight);
  crossing.barycentric[up_high] += (1 - toward_down) * up.weight;
  crossing.barycentric[down_low] += toward_down * (1 - down.weight);
  crossing.barycentric[down_high] += toward_down * down.weight;
  const double heights[3] = {corners[0][axis], corners[1][axis], corners[2][axis]};
  crossing.coordinate = coordinate_at(heights, crossing.barycentric.data(), 3);
  // Seen against the axis the triangle runs counter-clockwise, its normal along the axis, if the
  // rising edge is on the right.
  crossing.entering = up.u < down.u;
  return true;
}

}  // namespace

template <int dim>
bool cross_line(const std::array<Point<dim>, dim>& corners, int axis, const Point<dim>& x,
                Crossing<dim>& crossing) {
  if constexpr (dim == 2) {
    return cross_segment(corners, axis, x, crossing);
  } else {
    return cross_triangle(corners, axis, x, crossing);
  }
}

template bool cross_line<2>(const std::array<Point<2>, 2>&, int, const Point<2>&, Crossing<2>&);
template bool cross_line<3>(const std::array<Point<3>, 3>&, int, const Point<3>&, Crossing<3>&);

}  // namespace lockstep
