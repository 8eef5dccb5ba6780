#include "geometry/simplex_queries.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface_mesh.hpp"

namespace lockstep {

namespace {

constexpr double relative_tolerance = 1e-12;

/// Weight of q at the point of segment p -> q closest to x.
template <int dim>
double closest_on_edge(const Point<dim>& p, const Point<dim>& q, const Point<dim>& x) {
  const Point<dim> edge = q - p;
  const double square = edge.squaredNorm();
  return square > 0 ? std::clamp(edge.dot(x - p) / square, 0.0, 1.0) : 0.0;
}

template <int dim>
Point<dim> at_barycentric(const std::array<Point<dim>, dim>& corners,
                          const Barycentric<dim>& barycentric) {
  Point<dim> x = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    x += barycentric[k] * corners[k];
  return x;
}

template <int dim>
Barycentric<dim> clamped(Barycentric<dim> barycentric) {
  barycentric = barycentric.cwiseMax(0.0);
  return barycentric / barycentric.sum();
}

/// Barycentric coordinates of the projection of x on the plane of a simplex of non-zero measure.
template <int dim>
Barycentric<dim> projected_barycentric(const std::array<Point<dim>, dim>& corners,
                                       const Point<dim>& x) {
  Barycentric<dim> barycentric;
  if constexpr (dim == 2) {
    const Point<2> edge = corners[1] - corners[0];
    barycentric[1] = edge.dot(x - corners[0]) / edge.squaredNorm();
    barycentric[0] = 1 - barycentric[1];
  } else {
    const Point<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    const double square = normal.squaredNorm();
    for (int k = 0; k < 3; ++k) {
      const Point<3>& p = corners[(k + 1) % 3];
      barycentric[k] = normal.dot((corners[(k + 2) % 3] - p).cross(x - p)) / square;
    }
  }
  return barycentric;
}

/// Volumes spanned by the segment direction, seen from a, and each facet of the simplex: all of one
/// sign if the line passes through the simplex; their sum is direction x area vector (times two in
/// 3D).
template <int dim>
Barycentric<dim> line_volumes(const std::array<Point<dim>, dim>& corners, const Point<dim>& a,
                              const Point<dim>& direction) {
  std::array<Point<dim>, dim> seen;
  for (int k = 0; k < dim; ++k)
    seen[k] = corners[k] - a;
  Barycentric<dim> volumes;
  if constexpr (dim == 2) {
    volumes[0] = cross<2>(direction, seen[1])[0];
    volumes[1] = -cross<2>(direction, seen[0])[0];
  } else {
    for (int k = 0; k < 3; ++k)
      volumes[k] = direction.dot(seen[(k + 1) % 3].cross(seen[(k + 2) % 3]));
  }
  return volumes;
}

/// Length of the facet opposite to corner k (2D: the facet is a point and has "length" one).
template <int dim>
double facet_length(const std::array<Point<dim>, dim>& corners, int k) {
  if constexpr (dim == 2) {
    static_cast<void>(corners);
    static_cast<void>(k);
    return 1;
  } else {
    return (corners[(k + 1) % 3] - corners[(k + 2) % 3]).norm();
  }
}

/// First point of a segment that runs in the plane of the simplex.
template <int dim>
std::optional<SimplexHit<dim>> hit_in_plane(const std::array<Point<dim>, dim>& corners,
                                            const Point<dim>& a, const Point<dim>& b,
                                            double slack) {
  const double measure = area_vector<dim>(corners).norm();
  const Barycentric<dim> at_a = projected_barycentric<dim>(corners, a);
  const Barycentric<dim> at_b = projected_barycentric<dim>(corners, b);
  double first = 0, last = 1;
  for (int k = 0; k < dim; ++k) {
    const double height = (dim - 1) * measure / facet_length<dim>(corners, k);
    const double from = at_a[k] + slack / height, to = at_b[k] + slack / height;
    if (from < 0 && to < 0)
      return std::nullopt;
    if (from < 0)
      first = std::max(first, from / (from - to));
    if (to < 0)
      last = std::min(last, from / (from - to));
  }
  if (first > last)
    return std::nullopt;
  SimplexHit<dim> hit;
  hit.fraction = first;
  hit.barycentric = clamped<dim>((1 - first) * at_a + first * at_b);
  hit.position = at_barycentric<dim>(corners, hit.barycentric);
  return hit;
}

}  // namespace

template <int dim>
ClosestOnSimplex<dim> closest_on_simplex(const std::array<Point<dim>, dim>& corners,
                                         const Point<dim>& x) {
  ClosestOnSimplex<dim> best;
  if constexpr (dim == 3) {
    if (area_vector<dim>(corners).squaredNorm() > std::numeric_limits<double>::min()) {
      const Barycentric<dim> projected = projected_barycentric<dim>(corners, x);
      if (projected.minCoeff() >= 0) {
        best.barycentric = projected / projected.sum();
        best.position = at_barycentric<dim>(corners, best.barycentric);
        best.distance = (x - best.position).norm();
        return best;
      }
    }
  }
  best.distance = std::numeric_limits<double>::infinity();
  constexpr int n_edges = dim == 2 ? 1 : 3;
  for (int k = 0; k < n_edges; ++k) {
    const int p = k, q = (k + 1) % dim;
    const double weight = closest_on_edge<dim>(corners[p], corners[q], x);
    const Point<dim> position = (1 - weight) * corners[p] + weight * corners[q];
    const double distance = (x - position).norm();
    if (distance < best.distance) {
      best.barycentric.setZero();
      best.barycentric[p] = 1 - weight;
      best.barycentric[q] = weight;
      best.position = position;
      best.distance = distance;
    }
  }
  return best;
}

template <int dim>
std::optional<SimplexHit<dim>> hit_simplex(const std::array<Point<dim>, dim>& corners,
                                           const Point<dim>& a, const Point<dim>& b,
                                           double tolerance) {
  const Point<dim> direction = b - a;
  const double length = direction.norm();
  const Point<dim> area = area_vector<dim>(corners);
  if (area.squaredNorm() <= std::numeric_limits<double>::min())
    return std::nullopt;
  double size = length;
  for (const Point<dim>& corner : corners)
    size = std::max(size, (corner - a).norm());
  const double slack = tolerance + relative_tolerance * size;

  const Point<dim> normal = area.normalized();
  const double from = normal.dot(a - corners[0]), to = normal.dot(b - corners[0]);
  if (std::abs(from - to) <= relative_tolerance * size) {
    if (std::min(std::abs(from), std::abs(to)) > slack)
      return std::nullopt;
    return hit_in_plane<dim>(corners, a, b, slack);
  }
  const bool near_end = std::min(std::abs(from), std::abs(to)) <= slack;
  const double fraction = from / (from - to);
  if (!near_end && (fraction < -slack / length || fraction > 1 + slack / length))
    return std::nullopt;

  Barycentric<dim> volumes = line_volumes<dim>(corners, a, direction);
  if (volumes.sum() < 0)
    volumes = -volumes;
  for (int k = 0; k < dim; ++k)
    if (volumes[k] < -slack * length * facet_length<dim>(corners, k))
      return std::nullopt;

  SimplexHit<dim> hit;
  hit.fraction = std::clamp(fraction, 0.0, 1.0);
  hit.barycentric = clamped<dim>(volumes);
  hit.position = at_barycentric<dim>(corners, hit.barycentric);
  return hit;
}

template ClosestOnSimplex<2> closest_on_simplex<2>(const std::array<Point<2>, 2>&, const Point<2>&);
template ClosestOnSimplex<3> closest_on_simplex<3>(const std::array<Point<3>, 3>&, const Point<3>&);
template std::optional<SimplexHit<2>> hit_simplex<2>(const std::array<Point<2>, 2>&,
                                                     const Point<2>&, const Point<2>&, double);
template std::optional<SimplexHit<3>> hit_simplex<3>(const std::array<Point<3>, 3>&,
                                                     const Point<3>&, const Point<3>&, double);

}  // namespace lockstep
