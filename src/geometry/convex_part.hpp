#pragma once
#include <array>

#include "base/types.hpp"

namespace lockstep {

/// A segment (2D) or convex planar polygon (3D) that is cut down by axis-parallel planes. Triangles
/// cut by the six sides of a box have at most nine vertices.
template <int dim>
class ConvexPart {
 public:
  static constexpr int max_vertices = dim == 2 ? 2 : 12;

  explicit ConvexPart(const std::array<Point<dim>, dim>& corners) : n_(dim) {
    for (int k = 0; k < dim; ++k) {
      position_[k] = corners[k];
      barycentric_[k] = Barycentric<dim>::Unit(k);
    }
  }

  int n_vertices() const { return n_; }
  const Point<dim>& position(int i) const { return position_[i]; }
  const Barycentric<dim>& barycentric(int i) const { return barycentric_[i]; }

  /// Keeps what has x_axis >= bound (side +1) or <= bound (side -1); Sutherland-Hodgman.
  void keep(int axis, double bound, int side) {
    std::array<double, max_vertices> depth;
    bool any_outside = false;
    for (int i = 0; i < n_; ++i) {
      depth[i] = side * (position_[i][axis] - bound);
      any_outside = any_outside || depth[i] < 0;
    }
    if (!any_outside)
      return;
    const ConvexPart whole = *this;
    n_ = 0;
    for (int i = 0; i < whole.n_; ++i) {
      if (depth[i] >= 0)
        append(whole.position_[i], whole.barycentric_[i]);
      if (dim == 2 && i == 1)
        break;  // a segment has one edge only
      const int j = (i + 1) % whole.n_;
      if ((depth[i] > 0 && depth[j] < 0) || (depth[i] < 0 && depth[j] > 0)) {
        const double t = depth[i] / (depth[i] - depth[j]);
        append((1 - t) * whole.position_[i] + t * whole.position_[j],
               (1 - t) * whole.barycentric_[i] + t * whole.barycentric_[j]);
        position_[n_ - 1][axis] = bound;
      }
    }
  }

 private:
  void append(const Point<dim>& position, const Barycentric<dim>& barycentric) {
    position_[n_] = position;
    barycentric_[n_] = barycentric;
    ++n_;
  }

  int n_;
  std::array<Point<dim>, max_vertices> position_;
  std::array<Barycentric<dim>, max_vertices> barycentric_;
};

}  // namespace lockstep
