#pragma once
#include <array>
#include <vector>

#include "mac/ray_tracer.hpp"

namespace lockstep {

/// Values for one row of samples of a tile, along x.
template <int dim>
using RowValues = std::array<double, tile_width<dim>>;
/// Positions of such a row, by axis, relative to a block's first cell.
template <int dim>
using RowPoints = std::array<RowValues<dim>, dim>;

/// Ends of the rays of a row.
template <int dim>
struct RowRays {
  RowPoints<dim> end;
  std::array<bool, tile_width<dim>> clipped;  ///< it would have left the domain
};

/// A tile and its surroundings as dense arrays, in which short rays are followed a row at a time:
/// several times faster than one by one, with the same result. For tiles away from surfaces and
/// inflow sides.
template <int dim>
class TileBlock {
 public:
  /// Longer rays [cells] are better followed one by one.
  static constexpr int longest_reach = 6;
  /// Rays reach `reach` cells along each axis.
  TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer, int reach);

  /// Copies the velocity around the tile. False if samples there are missing: not for this tile.
  bool enter(const Index<dim>& tile_begin);
  /// Copies the field to be looked up around the same tile.
  void load(SampleKind kind, const double* field);

  /// Positions of the samples of a row with these coordinates within the tile (x is ignored).
  RowPoints<dim> row(SampleKind kind, const Index<dim>& in_tile) const;
  /// Rays by the midpoint rule, against the flow (direction -1) or with it (+1).
  RowRays<dim> trace(const RowPoints<dim>& start, double direction) const;
  /// The loaded field at a row of points.
  void look_up(const RowPoints<dim>& points, RowValues<dim>& values) const;
  /// The range of the samples used there.
  void look_up_range(const RowPoints<dim>& points, RowValues<dim>& low, RowValues<dim>& high) const;

 private:
  RowPoints<dim> displaced(const RowPoints<dim>& start, const RowPoints<dim>& at,
                           double factor) const;
  bool clamp(double& x, int axis) const;
  std::vector<int>& ids(SampleKind kind) { return ids_[kind == cell_centers ? dim : kind]; }
  static void copy(const std::vector<int>& ids, const double* field, std::vector<double>& block);

  const SampleLattice<dim>& lattice_;
  const RayTracer<dim>& tracer_;
  int reach_, width_;
  std::array<std::vector<int>, dim + 1> ids_;  ///< of the block's samples by kind, x fastest
  std::array<double, dim> lower_, upper_;      ///< the domain, relative to the block
  std::array<std::vector<double>, dim> velocity_;
  SampleKind kind_ = cell_centers;
  std::vector<double> field_;
};

}  // namespace lockstep
