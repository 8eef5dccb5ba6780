#pragma once
#include <array>

#include "base/types.hpp"

namespace lockstep {

/// A segment (2D) or convex planar polygon (3D) that is cut down by axis-parallel planes. Triangles
/// cut by the six sides of a box have at most nine vertices. The barycentric coordinates of the
/// vertices in the uncut simplex are followed on request.
template <int dim, bool with_barycentric>
class ConvexPart {
 public:
  static constexpr int max_vertices = dim == 2 ? 2 : 12;

  explicit ConvexPart(const std::array<Point<dim>, dim>& corners) : n_(dim) {
    for (int k = 0; k < dim; ++k) {
      position_[k] = corners[k];
      if constexpr (with_barycentric)
        barycentric_[k] = Barycentric<dim>::Unit(k);
    }
  }

  int n_vertices() const { return n_; }
  const Point<dim>& position(int i) const { return position_[i]; }
  const Barycentric<dim>& barycentric(int i) const {
    static_assert(with_barycentric);
    return barycentric_[i];
  }

  /// Keeps what has x_axis >= bound (side +1) or <= bound (side -1); Sutherland-Hodgman.
  void keep(int axis, double bound, int side) {
    std::array<double, max_vertices> depth;
    bool any_outside = false;
    for (int i = 0; i < n_; ++i) {
      depth[i] = side * (position_[i][axis] - bound);
      any_outside |= depth[i] < 0;
    }
    if (!any_outside)
      return;
    const int n_before = n_;
    Corners before;
    Weights weights_before;
    for (int i = 0; i < n_before; ++i) {
      before[i] = position_[i];
      if constexpr (with_barycentric)
        weights_before[i] = barycentric_[i];
    }
    n_ = 0;
    for (int i = 0; i < n_before; ++i) {
      if (depth[i] >= 0)
        append(before[i], weights_before, i, i, 0);
      if (dim == 2 && i == 1)
        break;  // a segment has one edge only
      const int j = i + 1 < n_before ? i + 1 : 0;
      if ((depth[i] > 0 && depth[j] < 0) || (depth[i] < 0 && depth[j] > 0)) {
        const double t = depth[i] / (depth[i] - depth[j]);
        Point<dim> cut = (1 - t) * before[i] + t * before[j];
        cut[axis] = bound;
        append(cut, weights_before, i, j, t);
      }
    }
  }

 private:
  using Corners = std::array<Point<dim>, max_vertices>;
  using Weights = std::array<Barycentric<dim>, with_barycentric ? max_vertices : 1>;

  /// Appends a vertex at fraction t between the former vertices i and j.
  void append(const Point<dim>& position, const Weights& weights, int i, int j, double t) {
    // Only round-off can make a polygon concave and give it more vertices; they are next to others.
    if (n_ == max_vertices)
      return;
    position_[n_] = position;
    if constexpr (with_barycentric)
      barycentric_[n_] = (1 - t) * weights[i] + t * weights[j];
    ++n_;
  }

  int n_;
  Corners position_;
  Weights barycentric_;
};

}  // namespace lockstep
