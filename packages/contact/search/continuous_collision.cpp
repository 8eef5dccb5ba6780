#include "contact/search/continuous_collision.hpp"

#include <algorithm>
#include <cmath>

#include "base/round_off.hpp"
#include "geometry/simplex_queries.hpp"

namespace lockstep {

namespace {

/// Barycentric coordinates by which a simplex is widened, so that there is no gap between
/// neighbours: chosen far above round-off, and far below what a mesh resolves.
constexpr double facet = 1e-6;
/// Square of the sine of the angle below which edges count as parallel: their common normal has
/// lost five digits there. Vertices against simplices find what such edges touch.
constexpr double parallel = 1e-10;

double value_at(const std::array<double, 4>& c, double t) {
  return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}

/// Zeros of the derivative in (0, 1), ascending.
std::vector<double> turning_points(const std::array<double, 4>& c) {
  const double a = 3 * c[3], b = 2 * c[2], d = c[1];
  std::vector<double> points;
  const double discriminant = b * b - 4 * a * d;
  if (discriminant >= 0) {
    // The stable pair of formulas; division by zero gives what the filter below drops.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    points = {q / a, d / q};
  }
  points.erase(
      std::remove_if(points.begin(), points.end(), [](double t) { return !(t > 0 && t < 1); }),
      points.end());
  std::sort(points.begin(), points.end());
  return points;
}

/// The root between two ends of different signs.
double bisected(const std::array<double, 4>& c, double lower, double upper) {
  const bool rising = value_at(c, upper) > 0;
  for (int i = 0; i < 60 && upper - lower > 1e-16; ++i) {
    const double middle = 0.5 * (lower + upper);
    ((value_at(c, middle) > 0) == rising ? upper : lower) = middle;
  }
  return 0.5 * (lower + upper);
}

/// Coefficients of the measure of the simplex that the moving points span.
std::array<double, 4> coplanarity(const PrimitivePoints<3>& before,
                                  const PrimitivePoints<3>& after) {
  std::array<Point<3>, 3> x, v;
  for (int k = 0; k < 3; ++k) {
    x[k] = before[k + 1] - before[0];
    v[k] = after[k + 1] - after[0] - x[k];
  }
  const auto det = [](const Point<3>& a, const Point<3>& b, const Point<3>& c) {
    return a.dot(b.cross(c));
  };
  return {
      det(x[0], x[1], x[2]), det(v[0], x[1], x[2]) + det(x[0], v[1], x[2]) + det(x[0], x[1], v[2]),
      det(x[0], v[1], v[2]) + det(v[0], x[1], v[2]) + det(v[0], v[1], x[2]), det(v[0], v[1], v[2])};
}

std::array<double, 4> coplanarity(const PrimitivePoints<2>& before,
                                  const PrimitivePoints<2>& after) {
  const Point<2> a = before[1] - before[0], b = before[2] - before[0];
  const Point<2> u = after[1] - after[0] - a, w = after[2] - after[0] - b;
  const auto det = [](const Point<2>& p, const Point<2>& q) { return cross<2>(p, q)[0]; };
  return {det(a, b), det(u, b) + det(a, w), det(u, w), 0};
}

struct EdgeCrossing {
  double s = 0, t = 0;  ///< fractions of the closest points of the lines
  Point<3> normal;      ///< not normalised
};
std::optional<EdgeCrossing> crossing_of(const PrimitivePoints<3>& x) {
  const Point<3> a = x[1] - x[0], b = x[3] - x[2], arm = x[2] - x[0];
  EdgeCrossing crossing;
  crossing.normal = a.cross(b);
  const double square = crossing.normal.squaredNorm();
  if (square <= parallel * a.squaredNorm() * b.squaredNorm())
    return {};
  crossing.s = arm.cross(b).dot(crossing.normal) / square;
  crossing.t = arm.cross(a).dot(crossing.normal) / square;
  return crossing;
}

PrimitiveWeights<3> weights_of(const EdgeCrossing& crossing) {
  return {1 - crossing.s, crossing.s, crossing.t - 1, -crossing.t};
}

bool within(double fraction, double widened) {
  return fraction >= -widened && fraction <= 1 + widened;
}

/// Weights and normal if coplanar primitives touch.
template <int dim>
std::optional<Impact<dim>> touching(PrimitiveKind kind, const PrimitivePoints<dim>& x) {
  Impact<dim> impact;
  if constexpr (dim == 3) {
    if (kind == PrimitiveKind::edge_edge) {
      const auto crossing = crossing_of(x);
      if (!crossing || !within(crossing->s, facet) || !within(crossing->t, facet))
        return {};
      impact.weights = weights_of(*crossing);
      impact.normal = crossing->normal.normalized();
      return impact;
    }
    const Point<3> normal = (x[2] - x[1]).cross(x[3] - x[1]);
    const double square = normal.squaredNorm();
    if (square == 0)
      return {};
    const double b = (x[0] - x[1]).cross(x[3] - x[1]).dot(normal) / square;
    const double c = (x[2] - x[1]).cross(x[0] - x[1]).dot(normal) / square;
    impact.weights << 1, b + c - 1, -b, -c;
    impact.normal = normal / std::sqrt(square);
  } else {
    const Point<2> along = x[2] - x[1];
    const double square = along.squaredNorm();
    if (square == 0)
      return {};
    const double t = (x[0] - x[1]).dot(along) / square;
    impact.weights << 1, t - 1, -t;
    impact.normal = Point<2>(-along.y(), along.x()) / std::sqrt(square);
  }
  if (impact.weights.template tail<dim>().maxCoeff() > facet)
    return {};
  return impact;
}

}  // namespace

std::vector<double> roots_in_unit_interval(const std::array<double, 4>& c) {
  const double size = std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]) + std::abs(c[3]);
  std::vector<double> roots;
  if (size == 0)
    return roots;
  const double zero = rounding::few * size;
  std::vector<double> ends{0};
  for (const double t : turning_points(c))
    ends.push_back(t);
  ends.push_back(1);
  const auto add = [&roots](double t) {
    if (roots.empty() || t - roots.back() > rounding::sums)
      roots.push_back(t);
  };
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const double value = value_at(c, ends[k]);
    if (std::abs(value) <= zero) {
      add(ends[k]);
    } else if (k + 1 < ends.size()) {
      const double next = value_at(c, ends[k + 1]);
      if (std::abs(next) > zero && (next > 0) != (value > 0))
        add(bisected(c, ends[k], ends[k + 1]));
    }
  }
  return roots;
}

template <int dim>
std::optional<ClosestPrimitives<dim>> closest_primitives(PrimitiveKind kind,
                                                         const PrimitivePoints<dim>& points) {
  ClosestPrimitives<dim> closest;
  if constexpr (dim == 3) {
    if (kind == PrimitiveKind::edge_edge) {
      const auto crossing = crossing_of(points);
      if (!crossing || !within(crossing->s, -facet) || !within(crossing->t, -facet))
        return {};
      closest.weights = weights_of(*crossing);
      closest.interior = true;
      closest.distance = weighted<3>(closest.weights, points).norm();
      return closest;
    }
  }
  std::array<Point<dim>, dim> corners;
  std::copy(points.begin() + 1, points.end(), corners.begin());
  const ClosestOnSimplex<dim> on_simplex = closest_on_simplex<dim>(corners, points[0]);
  closest.weights << 1, -on_simplex.barycentric;
  closest.interior = on_simplex.barycentric.minCoeff() > facet;
  closest.distance = on_simplex.distance;
  return closest;
}

template <int dim>
std::optional<Impact<dim>> first_impact(PrimitiveKind kind, const PrimitivePoints<dim>& before,
                                        const PrimitivePoints<dim>& after,
                                        const SideAtStart<dim>& side) {
  for (const double time : roots_in_unit_interval(coplanarity(before, after))) {
    PrimitivePoints<dim> middle;
    for (int k = 0; k <= dim; ++k)
      middle[k] = (1 - time) * before[k] + time * after[k];
    std::optional<Impact<dim>> impact = touching<dim>(kind, middle);
    if (!impact)
      continue;
    impact->time = time;
    const Point<dim> start = weighted<dim>(impact->weights, before);
    const Point<dim> motion = weighted<dim>(impact->weights, after) - start;
    const double approach = impact->normal.dot(motion);
    const double negligible = rounding::few * (before[1] - before[2]).norm();
    double out = -approach;  // sliding surfaces do not cross
    if (start.norm() <= negligible) {
      constexpr double steep = 0.5;
      if (!side || std::abs(approach) <= negligible)
        continue;
      out = impact->normal.dot(side(impact->weights, impact->normal));
      if (std::abs(out) < steep || out * approach >= 0)
        continue;
    }
    if (out == 0)
      continue;
    if (out < 0)
      impact->normal = -impact->normal;
    return impact;
  }
  return {};
}

template std::optional<ClosestPrimitives<2>> closest_primitives<2>(PrimitiveKind,
                                                                   const PrimitivePoints<2>&);
template std::optional<ClosestPrimitives<3>> closest_primitives<3>(PrimitiveKind,
                                                                   const PrimitivePoints<3>&);
template std::optional<Impact<2>> first_impact<2>(PrimitiveKind, const PrimitivePoints<2>&,
                                                  const PrimitivePoints<2>&, const SideAtStart<2>&);
template std::optional<Impact<3>> first_impact<3>(PrimitiveKind, const PrimitivePoints<3>&,
                                                  const PrimitivePoints<3>&, const SideAtStart<3>&);

}  // namespace lockstep
