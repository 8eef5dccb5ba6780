#pragma once
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Builds with ever smaller target spacings until no edge is longer than `spacing`.
/// `build(target)` returns a mesh whose edges are roughly `target` long.
template <int dim, typename Build>
SurfaceMesh<dim> build_to_spacing(double spacing, Build build) {
  double target = spacing;
  while (true) {
    SurfaceMesh<dim> mesh = build(target);
    double longest = 0;
    for (const auto& simplex : mesh.simplices)
      for (int k = 0; k < dim; ++k)
        longest = std::max(
            longest, (mesh.vertices[simplex[(k + 1) % dim]] - mesh.vertices[simplex[k]]).norm());
    if (longest <= spacing * (1 + 1e-12))
      return mesh;
    target *= std::clamp(spacing / longest, 0.5, 0.97);
  }
}

/// Checks the dimensions of a generated surface; `shape` is named in the messages.
inline void check_shape(const char* shape, double smallest, double largest, double spacing) {
  check_input(smallest > 0 && std::isfinite(largest),
              "{}: all dimensions must be positive, but one is {}.", shape,
              smallest > 0 ? largest : smallest);
  check_input(spacing > 0, "{}: the spacing of the surface mesh must be positive, but is {}.",
              shape, spacing);
  check_input(largest / spacing < 1e4,
              "{}: a spacing of {} on a body of size {} makes too fine a surface mesh; choose a "
              "spacing near the grid's.",
              shape, spacing, largest);
}

/// Number of equal steps no longer than `spacing` that make up `length`.
inline int n_steps(double length, double spacing) {
  return std::max(1, static_cast<int>(std::ceil(length / spacing * (1 - 1e-12))));
}

}  // namespace lockstep
