#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// A simplicial surface: segments in 2D, triangles in 3D. Simplices are oriented so that the normal
/// (2D: (dy, -dx) of the segment, 3D: right-hand rule) points out of the solid; for an open shell
/// the orientation only has to be consistent.
template <int dim>
struct SurfaceMesh {
  using Simplex = std::array<int, dim>;
  std::vector<Point<dim>> vertices;  ///< [m]
  std::vector<Simplex> simplices;
};

/// True if every edge (2D: vertex) is shared by exactly two simplices of opposite orientation.
template <int dim>
bool is_closed(const SurfaceMesh<dim>& mesh);

/// Throws InputError naming the offending simplex if the mesh has out-of-range vertices, degenerate
/// simplices, or (when `closed`) boundary edges or inconsistent orientation. An entirely inward
/// orientation is turned around. `name` is used in the message.
template <int dim>
void check_surface(SurfaceMesh<dim>& mesh, bool closed, const std::string& name);

/// Normal times length (2D) or area (3D) of a simplex [m, m^2].
template <int dim>
Point<dim> area_vector(const std::array<Point<dim>, dim>& corners) {
  if constexpr (dim == 2) {
    const Point<2> edge = corners[1] - corners[0];
    return {edge.y(), -edge.x()};
  } else {
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  }
}

/// Volume (2D: area per unit depth), centroid and second moments of the solid inside a closed
/// surface of unit density; for a shell, of its surface of unit surface density.
template <int dim>
struct MassProperties {
  double measure = 0;                        ///< volume [m^dim] or surface [m^(dim-1)]
  Point<dim> centroid = Point<dim>::Zero();  ///< [m]
  /// Inertia tensor about the centroid for density one (2D: 1x1 polar moment).
  Eigen::Matrix<double, n_rotations<dim>, n_rotations<dim>> inertia =
      Eigen::Matrix<double, n_rotations<dim>, n_rotations<dim>>::Zero();
};
template <int dim>
MassProperties<dim> volume_properties(const SurfaceMesh<dim>& mesh);
template <int dim>
MassProperties<dim> shell_properties(const SurfaceMesh<dim>& mesh);

}  // namespace lockstep
