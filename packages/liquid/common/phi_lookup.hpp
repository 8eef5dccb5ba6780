#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "liquid/common/solid_cells.hpp"
#include "transport/strip_values.hpp"
#include "transport/visible_interpolation.hpp"

namespace lockstep {

/// phi, and what hides it from points of the fluid.
template <int dim>
struct PhiAmongSolids {
  const MacDomain<dim>& domain;
  const SolidCells<dim>& solids;
  KeptSurface<dim>& kept;  ///< surface of `solids` near each rank's cells
  const CellField& phi;    ///< signed distance from the liquid's surface, negative inside [m]
};

/// phi at any point of one tile after the other: multilinear, near surfaces of solids from the
/// visible samples. Points are in cells from the lower corner of the tile.
template <int dim>
class PhiLookup {
 public:
  /// All references must outlive this. Points may lie `margin` - 1 cells outside of the tile; `phi`
  /// is known on a halo of width `margin`.
  PhiLookup(const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice,
            const SolidCells<dim>& solids, KeptSurface<dim>& kept, const CellField& phi,
            int margin = 1);

  /// Copies phi around an owned tile.
  void enter(int tile);
  /// Prepares the places and surfaces around an owned tile, without phi. Returns false if no
  /// surface comes within two cells of its points: none may be hidden.
  bool approach(int tile);
  /// None if nothing is visible from there.
  std::optional<double> value(const Point<dim>& x) const {
    if (may_be_hidden(x) || !is_complete_)
      return visible_->scalar(place(x), phi_.data());
    return unchecked_value(x);
  }
  /// phi at a point for which `values` has already found `plain`, its value without surfaces.
  std::optional<double> value(const Point<dim>& x, double plain) const {
    if (may_be_hidden(x) || !is_complete_)
      return visible_->scalar(place(x), phi_.data());
    return plain;
  }
  /// Gradient as if there were no surface [phi / cells].
  Point<dim> gradient(const Point<dim>& x) const;
  /// Values at several points at once, as if there were no surface; of use where all samples exist.
  StripValues<dim> values(const StripPoints<dim>& x) const;
  /// 0 where a sample does not exist.
  StripPoints<dim> gradients(const StripPoints<dim>& x) const;
  /// True if a surface comes between two points.
  bool hidden(const Point<dim>& a, const Point<dim>& b) const;
  /// True if a surface comes within two cells.
  bool may_be_hidden(const Point<dim>& x) const {
    return is_near_surface_ && is_within_two_cells(x);
  }
  /// Place of a point of the tile in lattice units.
  Point<dim> place(const Point<dim>& x) const { return x + begin_; }

 private:
  int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? width_ : width_ * width_; }
  double unchecked_value(const Point<dim>& x) const;
  bool is_within_two_cells(const Point<dim>& x) const;

  const TiledGrid<dim>& grid_;
  const SampleLattice<dim>& lattice_;
  const CellField& phi_;
  int margin_, width_;
  std::vector<char> is_fluid_;
  UsableSamples<dim> usable_;
  MovingSurface<dim> surface_;
  std::shared_ptr<const NearbySurface<dim>> nearby_;
  mutable std::unique_ptr<VisibleInterpolation<dim>> visible_;
  std::vector<double> block_;
  bool is_complete_ = false;
  bool is_near_surface_ = false;  ///< one may come within two cells of some point
  Point<dim> begin_ = Point<dim>::Zero();
};

template <int dim>
double PhiLookup<dim>::unchecked_value(const Point<dim>& x) const {
  int place = 0;
  std::array<double, dim> weight;
  for (int a = 0; a < dim; ++a) {
    const double t = x[a] + (margin_ - 0.5);
    const int below = static_cast<int>(t);
    weight[a] = t - below;
    place += below * stride(a);
  }
  const double* c = block_.data() + place;
  const auto along_x = [&](const double* row) { return row[0] + weight[0] * (row[1] - row[0]); };
  const auto in_plane = [&](const double* plane) {
    const double low = along_x(plane);
    return low + weight[1] * (along_x(plane + width_) - low);
  };
  const double low = in_plane(c);
  if constexpr (dim == 2)
    return low;
  else
    return low + weight[2] * (in_plane(c + width_ * width_) - low);
}

}  // namespace lockstep
