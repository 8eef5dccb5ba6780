#include "geometry/self_crossing.hpp"

#include <algorithm>
#include <optional>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

namespace {

/// -1, 0 or 1; 0 within the tolerance.
int sign(double value, double tolerance) {
  return value > tolerance ? 1 : value < -tolerance ? -1 : 0;
}

double side(const Point<2>& a, const Point<2>& b, const Point<2>& x) {
  return (b.x() - a.x()) * (x.y() - a.y()) - (b.y() - a.y()) * (x.x() - a.x());
}
double side(const Point<3>& a, const Point<3>& b, const Point<3>& c, const Point<3>& x) {
  return (b - a).cross(c - a).dot(x - a);
}

std::optional<Point<2>> crossing(const std::array<Point<2>, 2>& s, const std::array<Point<2>, 2>& t,
                                 double length) {
  const double tolerance = 1e-12 * length * length;
  const double a = side(t[0], t[1], s[0]), b = side(t[0], t[1], s[1]);
  if (sign(a, tolerance) * sign(b, tolerance) >= 0 ||
      sign(side(s[0], s[1], t[0]), tolerance) * sign(side(s[0], s[1], t[1]), tolerance) >= 0)
    return std::nullopt;
  return Point<2>(s[0] + a / (a - b) * (s[1] - s[0]));
}

/// Returns the point at which an edge of `s` goes through the inside of `t`.
std::optional<Point<3>> edge_crossing(const std::array<Point<3>, 3>& s,
                                      const std::array<Point<3>, 3>& t, double length) {
  const double tolerance = 1e-12 * length * length * length;
  std::array<double, 3> height;
  for (int k = 0; k < 3; ++k)
    height[k] = side(t[0], t[1], t[2], s[k]);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    if (sign(height[k], tolerance) * sign(height[l], tolerance) >= 0)
      continue;
    int sum = 0;
    for (int e = 0; e < 3; ++e)
      sum += sign(side(s[k], s[l], t[e], t[(e + 1) % 3]), tolerance);
    if (sum == 3 || sum == -3)
      return Point<3>(s[k] + height[k] / (height[k] - height[l]) * (s[l] - s[k]));
  }
  return std::nullopt;
}
std::optional<Point<3>> crossing(const std::array<Point<3>, 3>& s, const std::array<Point<3>, 3>& t,
                                 double length) {
  const auto found = edge_crossing(s, t, length);
  return found ? found : edge_crossing(t, s, length);
}

template <int dim>
SurfaceSnapshot<dim> snapshot_of(const SurfaceMesh<dim>& mesh) {
  SolidDescription solid;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return {mesh, {solid}};
}

}  // namespace

template <int dim>
SelfCrossing<dim> find_self_crossing(const SurfaceMesh<dim>& mesh) {
  const SurfaceSnapshot<dim> snapshot = snapshot_of(mesh);
  SelfCrossing<dim> result;
  std::vector<int> found;
  for (int s = 0; s < snapshot.n_simplices(); ++s) {
    const auto corners = snapshot.corners(s);
    double length = 0;
    for (int k = 0; k < dim; ++k)
      length = std::max(length, (corners[(k + 1) % dim] - corners[k]).norm());
    snapshot.touching(snapshot.bounds(s), found);
    for (const int t : found) {
      const auto place = t > s ? crossing(corners, snapshot.corners(t), length) : std::nullopt;
      if (!place)
        continue;
      if (result.n_pairs++ == 0) {
        result.first = s;
        result.second = t;
        result.place = *place;
      }
    }
  }
  return result;
}

template SelfCrossing<2> find_self_crossing(const SurfaceMesh<2>&);
template SelfCrossing<3> find_self_crossing(const SurfaceMesh<3>&);

}  // namespace lockstep
