#pragma once
#include <array>
#include <vector>

#include "transport/ray_tracer.hpp"
#include "transport/strip_values.hpp"

namespace lockstep {

/// The rays of a row.
template <int dim>
struct StripRays {
  StripPoints<dim> middle, end;  ///< where the midpoint rule looked, and the ends
  /// Not 0 where a ray would have left the domain.
  StripValues<dim> clipped;
};

/// A tile and its surroundings as dense arrays, in which short rays are followed a strip at a time:
/// many times faster than one by one, with the same result up to round-off (positions are relative
/// to the block). For tiles away from inflow sides; surfaces are ignored.
template <int dim>
class TileBlock {
 public:
  /// Longer rays [cells] are better followed one by one.
  static constexpr int longest_reach = 6;
  /// Rays reach `reach` cells along each axis, and their stencils `stencil_reach` farther: 1, or 2
  /// for cubics.
  TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer, int reach,
            int stencil_reach);

  /// Copies the velocity around the tile. Returns false if samples there are missing: the block
  /// cannot serve this tile.
  bool enter(const Index<dim>& tile_begin);
  /// Copies the field to be looked up around the same tile.
  void load(SampleKind kind, const double* field);

  /// Rays by the midpoint rule, against the flow (direction -1) or with it (+1), from the row of
  /// samples of the loaded field with these coordinates within the tile (x is ignored).
  /// `cubic`: the velocity is interpolated by cubics.
  StripRays<dim> trace(const Index<dim>& in_tile, double direction, bool cubic = false) const;
  /// Follows rays from any points of the tile, relative to the block; linear alone.
  StripRays<dim> follow(const StripPoints<dim>& start, double direction) const;
  /// Offset of the tile in the block: points count in cells from the tile's lower corner.
  int margin(int axis) const { return margin_[axis]; }
  /// Returns point i of a strip, in lattice units.
  Point<dim> place(const StripPoints<dim>& points, int i) const {
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = begin_[a] + points[a][i];
    return x;
  }
  /// The loaded field at a row of points.
  void look_up(const StripPoints<dim>& points, StripValues<dim>& values) const;
  /// Interpolates at these points, and finds the range of the samples used there.
  void look_up(const StripPoints<dim>& points, StripValues<dim>& values, StripValues<dim>& low,
               StripValues<dim>& high) const;
  /// Interpolates by cubics, within the range of the 4^dim samples around each point.
  void look_up_cubic(const StripPoints<dim>& points, StripValues<dim>& values) const;

 private:
  /// All components at a row of points.
  StripPoints<dim> velocity_at(const StripPoints<dim>& points, bool cubic) const;
  /// Places of the first and last sample of that kind along an axis in the block; without end if it
  /// is periodic.
  std::array<double, 2> sample_limits(int axis, SampleKind kind) const;
  /// Velocity component at a row of samples of the loaded field, the first at that place.
  StripValues<dim> velocity_at_samples(int axis, int place) const;
  /// The midpoint rule, given the velocity at the start; displacements are `factor` times velocity.
  /// The first `n_in_row` points count.
  StripRays<dim> rays_from(const StripPoints<dim>& start, const StripPoints<dim>& velocity,
                           double factor, int n_in_row, bool cubic) const;

  using Runs = std::vector<typename SampleLattice<dim>::Run>;
  using Values = std::vector<double, Eigen::aligned_allocator<double>>;
  /// The place of the first sample in the storage: row loads may begin or end one place outside.
  static constexpr int first_place = tile_width<dim>;
  bool copy(SampleKind kind, const double* from, Values& to) const;

  const SampleLattice<dim>& lattice_;
  const RayTracer<dim>& tracer_;
  /// Cells before the tile, and of all. Multiples of 4 along x, so that rows are copied fast.
  std::array<int, dim> margin_, width_;
  int stencil_reach_;
  Index<dim> begin_{};                         ///< first cell of the block
  int n_in_row_ = 0;                           ///< samples of the tile along x, of any kind
  std::array<std::array<Runs, 2>, dim> runs_;  ///< [axis][of faces normal to it]
  std::array<int, dim> stride_{};              ///< strides of neighbours in the block
  std::array<double, dim> lower_{}, upper_{};  ///< where rays may go, relative to the block
  std::array<Values, dim> velocity_;
  SampleKind kind_ = cell_centers;  ///< kind of the loaded field
  Point<dim> offset_;               ///< offset of its samples in their cells
  const double* field_ = nullptr;   ///< its samples
  Values storage_;  ///< storage of its values, unless they are those of the velocity
};

}  // namespace lockstep
