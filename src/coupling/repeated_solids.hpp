#pragma once
#include <array>
#include <vector>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// The solids that go round a periodic domain. Their own places go on beyond its sides. Snapshots
/// show each where its middle is in the domain, and images of those that reach across a side.
/// Local, the same on all ranks.
template <int dim>
class RepeatedSolids {
 public:
  RepeatedSolids() = default;  ///< none
  /// `wanted`: by solid, those to be repeated; all but what is too long to be told from its own
  /// image are. `margin`: surfaces farther outside of the domain are not needed [m].
  RepeatedSolids(const Box<dim>& domain, const std::array<bool, dim>& periodic, double margin,
                 const std::vector<SolidDescription>& solids, const SurfaceMesh<dim>& mesh,
                 std::vector<char> wanted);

  bool empty() const { return images_.repeated.empty(); }
  bool includes(int solid) const { return images_.repeats(solid); }
  double margin() const { return margin_; }
  /// Returns what was shown last.
  const SolidImages<dim>& images() const { return images_; }
  /// Returns the image of x that is nearest to the solid's own place; x if it is not repeated.
  Point<dim> own_place(int solid, const Point<dim>& x) const {
    return includes(solid) ? images_.nearest(x, own_middle_[solid]) : x;
  }
  int solid_of(int own_simplex) const { return solid_of_simplex_[own_simplex]; }
  /// Returns a point of the snapshot shown last with the simplex and place of the solid itself.
  SurfacePoint<dim> own_point(SurfacePoint<dim> point) const;
  /// Moves solids from their own places into the domain and finds their further images, also those
  /// that a snapshot of `before` needs (null: none).
  void show(const std::vector<SolidDescription>& solids, const SurfaceSnapshot<dim>* before,
            SurfaceMesh<dim>& mesh);

 private:
  Box<dim> domain_;
  double margin_ = 0;
  SolidImages<dim> images_;
  std::vector<int> solid_of_simplex_;
  std::vector<int> simplex_of_image_;   ///< own simplex of each that further images have
  std::vector<Point<dim>> own_middle_;  ///< by solid, at its own place [m]
};

}  // namespace lockstep
