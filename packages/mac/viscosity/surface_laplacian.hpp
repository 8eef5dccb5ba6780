#pragma once
#include <array>

#include "mac/state/mac_geometry.hpp"

namespace lockstep {

/// The surface Laplacian of each component of the velocity in its weak form,
///   sum of V delta(phi) grad_s u . grad_s v,
/// over the cubes that 2^dim velocities of an axis are the corners of: delta is a cosine that ends
/// 1.5 h off the surface, grad_s what of the gradient is along it. Only free velocities have a
/// part: where others are missing, as in the void, what is left says how u changes along the
/// surface. So the form is symmetric, not negative, and zero where u is constant.
template <int dim>
class SurfaceLaplacian {
 public:
  /// `distance`: phi [m] on all stored cells, mirrored at the sides of the domain. References must
  /// outlive this.
  SurfaceLaplacian(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                   const CellField& distance)
      : domain_(domain), geometry_(geometry), distance_(distance) {}

  /// Calls f(FaceId, coefficient [m^(dim - 3)]) for the row of a free face of this rank, itself
  /// included; a face may come more than once. Local.
  template <typename Function>
  void for_each_entry(const FaceId& face, const Function& f) const {
    if (std::abs(distance_[face.cell]) > 3 * domain_.spacing())
      return;
    const Index<dim> place = domain_.grid.coordinates(face.cell);
    for (int corner = 0; corner < n_corners; ++corner) {
      Index<dim> lowest = place;
      for (int a = 0; a < dim; ++a)
        lowest[a] -= corner >> a & 1;
      Cube cube;
      if (!make_cube(face.axis, lowest, cube))
        continue;
      for (int other = 0; other < n_corners; ++other)
        if (const double value = cube.form(corner, other); value != 0)
          f(FaceId{face.axis, cube.cells[other]}, value);
    }
  }

 private:
  static constexpr int n_corners = 1 << dim;
  struct Cube {
    std::array<int, n_corners> cells;     ///< of its faces
    std::array<bool, n_corners> is_free;  ///< corner k is upper along a where bit a is set
    Eigen::Matrix<double, n_corners, n_corners> form;
  };

  /// False if it has none.
  bool make_cube(int axis, const Index<dim>& lowest, Cube& cube) const;
  /// delta [1/m] and the surface's normal in its middle; false far from the surface.
  bool look(int axis, const Index<dim>& lowest, double& delta, Point<dim>& normal) const;
  double distance_at(Index<dim> cell) const;
  bool is_bonded(const Cube& cube, int axis, int corner, int along) const;
  double part_in_domain(int axis, const Index<dim>& lowest) const;

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const CellField& distance_;
};

}  // namespace lockstep
