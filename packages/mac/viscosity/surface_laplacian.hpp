#pragma once
#include <array>
#include <cstdint>
#include <unordered_map>

#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// The surface Laplacian of each component of the velocity in its weak form,
///   sum of V delta(phi) grad_s u . grad_s v,
/// over the cubes that 2^dim velocities of an axis are the corners of: delta is a cosine that ends
/// 1.5 h off the surface, grad_s the tangential part of the gradient. Only free velocities have a
/// part: where others are missing, as in the air, the rest tell how u changes along the surface. So
/// the form is symmetric, not negative, and zero where u is constant.
template <int dim>
class SurfaceLaplacian {
 public:
  /// `distance`: phi [m] on all stored cells, mirrored at the sides of the domain. References must
  /// outlive this.
  SurfaceLaplacian(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                   const CellField& distance)
      : domain_(domain), geometry_(geometry), distance_(distance) {}

  /// Calls f(FaceId, coefficient [m^(dim - 3)]) once for each entry of the row of a free face of
  /// this rank, itself included. Cheap where the faces of an axis come one after the other. Local.
  template <typename Function>
  void for_each_entry(const FaceId& face, const Function& f) {
    if (!is_near(face.cell))
      return;
    constexpr int n_neighbors = dim == 2 ? 9 : 27;
    std::array<double, n_neighbors> row{};
    std::array<int, n_neighbors> cells;
    const Index<dim> place = domain_.grid.coordinates(face.cell);
    for (int corner = 0; corner < n_corners; ++corner) {
      Index<dim> lowest = place;
      for (int a = 0; a < dim; ++a)
        lowest[a] -= corner >> a & 1;
      const Cube* cube = cube_at(face.axis, lowest);
      if (!cube)
        continue;
      for (int other = 0; other < n_corners; ++other) {
        int at = 0;  // among the neighbours, from -1 to 1 along each axis
        for (int a = dim - 1; a >= 0; --a)
          at = 3 * at + 1 + (other >> a & 1) - (corner >> a & 1);
        row[at] += cube->form(corner, other);
        cells[at] = cube->cells[other];
      }
    }
    for (int at = 0; at < n_neighbors; ++at)
      if (row[at] != 0)
        f(FaceId{face.axis, cells[at]}, row[at]);
  }

 private:
  static constexpr int n_corners = 1 << dim;
  struct Cube {
    bool is_empty = false;
    std::array<int, n_corners>
        cells;  ///< cells of its faces; corner k is upper along a where bit a is set
    Eigen::Matrix<double, n_corners, n_corners> form;
  };

  /// True if a face of the cell may be a corner of a cube that has a form.
  bool is_near(int cell) const { return std::abs(distance_[cell]) <= 3 * domain_.spacing(); }
  /// Returns the cube; null if it has no form.
  const Cube* cube_at(int axis, const Index<dim>& lowest);
  /// Makes a cube; returns false if it has no form.
  bool make_cube(int axis, const Index<dim>& lowest, Cube& cube) const;
  /// delta [1/m] and the surface's normal in its middle; false far from the surface.
  bool look(int axis, const Index<dim>& lowest, double& delta, Point<dim>& normal) const;
  double distance_at(Index<dim> cell) const;
  /// True if the velocities of neighbouring cells tell how u changes between them.
  bool is_coupled_across(int axis, int lower, int upper, int along) const;
  double part_in_domain(int axis, const Index<dim>& lowest) const;

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const CellField& distance_;
  int axis_ = -1;  ///< axis of the cubes made so far, by their lowest corner
  std::unordered_map<std::int64_t, Cube> cubes_;
};

}  // namespace lockstep
