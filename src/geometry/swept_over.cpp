#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "geometry/simplex_queries.hpp"
#include "geometry/surface_snapshot.hpp"

namespace lockstep {

namespace {

/// c0 + c1 t + c2 t^2 + c3 t^3.
struct Cubic {
  std::array<double, 4> c{};
  double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
};

/// Volume (2D: area, up to a constant) spanned by x and a simplex whose corners, seen from x, move
/// from `start` by `step`: it vanishes when x lies in the plane of the simplex.
Cubic spanned_volume(const std::array<Point<2>, 2>& start, const std::array<Point<2>, 2>& step) {
  const auto volume = [](const Point<2>& a, const Point<2>& b) { return cross<2>(a, b)[0]; };
  return {{volume(start[0], start[1]), volume(step[0], start[1]) + volume(start[0], step[1]),
           volume(step[0], step[1]), 0}};
}
Cubic spanned_volume(const std::array<Point<3>, 3>& start, const std::array<Point<3>, 3>& step) {
  const auto volume = [](const Point<3>& a, const Point<3>& b, const Point<3>& c) {
    return a.dot(b.cross(c));
  };
  const auto& [a, b, c] = start;
  const auto& [p, q, r] = step;
  return {{volume(a, b, c), volume(p, b, c) + volume(a, q, c) + volume(a, b, r),
           volume(a, q, r) + volume(p, b, r) + volume(p, q, c), volume(p, q, r)}};
}

/// Interior extrema of the cubic in (0, 1), ascending.
int extrema(const Cubic& f, std::array<double, 2>& times) {
  const double a = 3 * f.c[3], half_b = f.c[2], c = f.c[1];
  std::array<double, 2> roots;
  int n_roots = 0;
  const double discriminant = half_b * half_b - a * c;
  if (discriminant > 0) {
    // The form without cancellation; a vanishing leading coefficient drops one root.
    const double q = -(half_b + std::copysign(std::sqrt(discriminant), half_b));
    if (a != 0)
      roots[n_roots++] = q / a;
    if (q != 0)
      roots[n_roots++] = c / q;
  }
  int n = 0;
  for (int i = 0; i < n_roots; ++i)
    if (roots[i] > 0 && roots[i] < 1)
      times[n++] = roots[i];
  if (n == 2 && times[0] > times[1])
    std::swap(times[0], times[1]);
  return n;
}

double bisect(const Cubic& f, double low, double high) {
  const bool positive = f(low) > 0;
  for (int i = 0; i < 60 && high - low > 1e-16; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0) == positive ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Roots in (0, 1], ascending: between neighbouring extrema the cubic is monotone. Values below
/// `zero` count as zero: at the start they are no root, at an extremum or the end they are.
int roots_in_step(const Cubic& f, double zero, std::array<double, 4>& roots) {
  std::array<double, 2> turns;
  const int n_turns = extrema(f, turns);
  int n = 0;
  double low = 0, at_low = f(0);
  for (int i = 0; i <= n_turns; ++i) {
    const double high = i < n_turns ? turns[i] : 1, at_high = f(high);
    if (std::abs(at_high) <= zero) {
      if (std::abs(at_low) > zero || i > 0)
        roots[n++] = high;
    } else if (std::abs(at_low) > zero && (at_low > 0) != (at_high > 0)) {
      roots[n++] = bisect(f, low, high);
    }
    low = high;
    at_low = at_high;
  }
  return n;
}

template <int dim>
std::optional<SurfacePoint<dim>> first_passage(const std::array<Point<dim>, dim>& before,
                                               const std::array<Point<dim>, dim>& after,
                                               const Point<dim>& x) {
  Box<dim> swept;
  for (int k = 0; k < dim; ++k) {
    swept.extend(before[k]);
    swept.extend(after[k]);
  }
  const double size = swept.diagonal().norm();
  const double tolerance = 1e-8 * size;  // a flat contact of f with zero costs half of the digits
  if (swept.squaredExteriorDistance(x) > tolerance * tolerance)
    return std::nullopt;

  std::array<Point<dim>, dim> start, step;
  for (int k = 0; k < dim; ++k) {
    start[k] = before[k] - x;
    step[k] = after[k] - before[k];
  }
  std::array<double, 4> roots;
  const int n_roots =
      roots_in_step(spanned_volume(start, step), 1e-14 * std::pow(size, dim), roots);
  for (int i = 0; i < n_roots; ++i) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = before[k] + roots[i] * step[k];
    const auto near = closest_on_simplex<dim>(corners, x);
    if (near.distance <= tolerance)
      return SurfacePoint<dim>{-1, near.barycentric, near.position, roots[i]};
  }
  return std::nullopt;
}

}  // namespace

template <int dim>
std::optional<SurfacePoint<dim>> swept_over(const SurfaceSnapshot<dim>& before,
                                            const SurfaceSnapshot<dim>& after, const Point<dim>& x,
                                            const std::vector<int>& candidates) {
  LOCKSTEP_ASSERT(before.n_simplices() == after.n_simplices());
  std::optional<SurfacePoint<dim>> first;
  for (const int s : candidates) {
    auto passage = first_passage<dim>(before.corners(s), after.corners(s), x);
    if (!passage || (first && passage->fraction >= first->fraction))
      continue;
    first = passage;
    first->simplex = s;
  }
  return first;
}

template <int dim>
std::optional<SurfacePoint<dim>> swept_over(const SurfaceSnapshot<dim>& before,
                                            const SurfaceSnapshot<dim>& after,
                                            const Point<dim>& from, const Point<dim>& to,
                                            const std::vector<int>& candidates) {
  LOCKSTEP_ASSERT(before.n_simplices() == after.n_simplices());
  std::optional<SurfacePoint<dim>> first;
  for (const int s : candidates) {
    // corners in the frame of the moving point
    auto corners = after.corners(s);
    for (Point<dim>& corner : corners)
      corner -= to - from;
    auto passage = first_passage<dim>(before.corners(s), corners, from);
    if (!passage || (first && passage->fraction >= first->fraction))
      continue;
    first = passage;
    first->simplex = s;
  }
  return first;
}

template std::optional<SurfacePoint<2>> swept_over<2>(const SurfaceSnapshot<2>&,
                                                      const SurfaceSnapshot<2>&, const Point<2>&,
                                                      const std::vector<int>&);
template std::optional<SurfacePoint<3>> swept_over<3>(const SurfaceSnapshot<3>&,
                                                      const SurfaceSnapshot<3>&, const Point<3>&,
                                                      const std::vector<int>&);

template std::optional<SurfacePoint<2>> swept_over<2>(const SurfaceSnapshot<2>&,
                                                      const SurfaceSnapshot<2>&, const Point<2>&,
                                                      const Point<2>&, const std::vector<int>&);
template std::optional<SurfacePoint<3>> swept_over<3>(const SurfaceSnapshot<3>&,
                                                      const SurfaceSnapshot<3>&, const Point<3>&,
                                                      const Point<3>&, const std::vector<int>&);

}  // namespace lockstep
