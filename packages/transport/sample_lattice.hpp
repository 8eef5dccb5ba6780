#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Kind of a sample of the staggered grid: on the faces normal to an axis (0 .. dim-1), or at cell
/// centres.
using SampleKind = int;
constexpr SampleKind cell_centers = -1;

/// Position of a sample in its cell, in cells from the cell's lower corner.
template <int dim>
Point<dim> sample_offset(SampleKind kind) {
  Point<dim> offset = Point<dim>::Constant(0.5);
  if (kind != cell_centers)
    offset[kind] = 0;
  return offset;
}

/// The 2^dim samples around a point and the weight of the upper ones along each axis.
template <int dim>
struct Stencil {
  /// Ids below 0 have no storage: `wall_sample` is a velocity that is zero, any other is missing.
  static constexpr int wall_sample = std::numeric_limits<int>::min();

  std::array<int, 1 << dim> id;  ///< bit a of the position: upper along axis a
  std::array<double, dim> weight;

  bool complete() const {
    for (const int i : id)
      if (i < 0 && i != wall_sample)
        return false;
    return true;
  }
};

/// One of the samples around a point, for loops over single samples.
template <int dim>
struct StencilCorner {
  int id = 0;
  double weight = 0;
  Point<dim> position = Point<dim>::Zero();  ///< lattice units, not wrapped
};

/// Multilinear interpolation; exact for constants. The stencil is complete.
template <int dim>
double interpolate(const Stencil<dim>& stencil, const double* field) {
  std::array<double, 1 << dim> value;
  for (int k = 0; k < 1 << dim; ++k)
    value[k] = stencil.id[k] < 0 ? 0.0 : field[stencil.id[k]];
  for (int a = 0; a < dim; ++a)
    for (int k = 0; k < 1 << (dim - 1 - a); ++k)
      value[k] = value[2 * k] + stencil.weight[a] * (value[2 * k + 1] - value[2 * k]);
  return value[0];
}

/// The 4^dim samples around a point and their weights along each axis, for cubic interpolation.
template <int dim>
struct WideStencil {
  std::array<int, 1 << (2 * dim)> id;  ///< digits of the place, to base 4, x first; as in Stencil
  std::array<std::array<double, 4>, dim> weight;

  bool complete() const {
    for (const int i : id)
      if (i < 0 && i != Stencil<dim>::wall_sample)
        return false;
    return true;
  }
};

/// Cubic interpolation, clamped to the range of the samples, so that constants stay exact; the
/// stencil is complete.
template <int dim>
double interpolate(const WideStencil<dim>& stencil, const double* field) {
  double sum = 0, low = std::numeric_limits<double>::infinity(), high = -low;
  for (int k = 0; k < 1 << (2 * dim); ++k) {
    const double value = stencil.id[k] < 0 ? 0.0 : field[stencil.id[k]];
    double weight = 1;
    for (int a = 0; a < dim; ++a)
      weight *= stencil.weight[a][(k >> (2 * a)) & 3];
    sum += weight * value;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return std::clamp(sum, low, high);
}

/// Finds the samples around a point. Works in lattice units: x = (position - lower) / h, so that a
/// cell spans [i, i + 1]. Copies what it needs of the grid: the ids of stored tiles, in a table
/// over their bounding box.
template <int dim>
class SampleLattice {
 public:
  /// `beyond`: fields have one more tile, behind those stored, that stands for all that do not
  /// exist (RayHalo::fetch); else samples there are missing.
  explicit SampleLattice(const TiledGrid<dim>& grid, bool beyond = false);

  /// Samples around x: periodic axes wrap, others stop at their last sample.
  Stencil<dim> locate(SampleKind kind, const Point<dim>& x) const;
  /// Samples around x of all components of a velocity.
  std::array<Stencil<dim>, dim> locate_faces(const Point<dim>& x) const;
  /// The samples of a cubic around x, which is moved between the outermost samples of axes that are
  /// not periodic; beside these the samples of a parabola.
  WideStencil<dim> locate_wide(SampleKind kind, Point<dim> x) const;
  /// The samples around x with their weights and places.
  std::array<StencilCorner<dim>, (1 << dim)> corners(SampleKind kind, const Point<dim>& x) const;

  const Index<dim>& n_cells() const { return n_cells_; }
  /// The last sample along an axis that is not periodic.
  int last_sample(int axis, SampleKind kind) const {
    return n_cells_[axis] - (axis == kind ? 0 : 1);
  }
  bool periodic(int axis) const { return periodic_[axis]; }

  /// Neighbouring places of a block along one axis whose samples are neighbours in their tile too.
  struct Run {
    int begin = 0, length = 0;  ///< places in the block
    int tile = 0;               ///< share of the place in the tile table
    int offset = 0;             ///< share of the first place's offset in the tile
    bool at_wall = false;
  };
  /// Finds the runs of `width` places from `begin`; `on_faces`: places of faces normal to the axis.
  std::vector<Run> find_runs(int axis, bool on_faces, int begin, int width) const;
  /// Copies the samples of a box of cells, x fastest, in rows and planes of `stride`; runs[axis]
  /// are those of the box. False if any sample is missing.
  bool copy_block(const std::array<const std::vector<Run>*, dim>& runs,
                  const std::array<int, dim>& stride, const double* field, double* block) const;

 private:
  /// The two samples around x along one axis.
  struct Pair {
    std::array<int, 2> tile;    ///< share of the place in the tile table
    std::array<int, 2> offset;  ///< share of the offset in the tile
    std::array<bool, 2> at_wall{};
    double weight;
  };
  Pair find_pair(int axis, bool on_faces, double x) const;
  Stencil<dim> combine(const std::array<const Pair*, dim>& pairs) const;
  /// Sample coordinate after wrapping and clamping.
  int resolve(int axis, bool on_faces, int i) const;
  /// Share of a sample coordinate in the place in the tile table.
  int table_share(int axis, int i) const {
    const int tile = (i >> log_tile_width<dim>)-table_lower_[axis];
    return std::clamp(tile, 0, table_size_[axis] - 1) * table_stride_[axis];
  }

  Index<dim> n_cells_;
  std::array<bool, dim> periodic_;
  std::array<bool, dim> virtual_wall_;  ///< the upper side's faces are not stored: zero velocity
  Index<dim> table_lower_{}, table_size_{},
      table_stride_{};  ///< one ring without tiles around them
  std::vector<int> table_;
};

template <int dim>
int SampleLattice<dim>::resolve(int axis, bool on_faces, int i) const {
  const int n = n_cells_[axis];
  if (periodic_[axis]) {
    if (i >= 0 && i < n)
      return i;
    i %= n;
    return i < 0 ? i + n : i;
  }
  return std::clamp(i, 0, on_faces ? n : n - 1);
}

template <int dim>
typename SampleLattice<dim>::Pair SampleLattice<dim>::find_pair(int axis, bool on_faces,
                                                                double x) const {
  constexpr int log_width = log_tile_width<dim>;
  const double t = on_faces ? x : x - 0.5;
  const double floor_t = std::floor(t);
  Pair pair;
  pair.weight = t - floor_t;
  for (int k = 0; k < 2; ++k) {
    int i = static_cast<int>(floor_t) + k;
    i = resolve(axis, on_faces, i);
    pair.at_wall[k] = on_faces && virtual_wall_[axis] && i == n_cells_[axis];
    pair.tile[k] = table_share(axis, i);
    pair.offset[k] = (i & (tile_width<dim> - 1)) << (log_width * axis);
  }
  return pair;
}

template <int dim>
Stencil<dim> SampleLattice<dim>::combine(const std::array<const Pair*, dim>& pairs) const {
  Stencil<dim> stencil;
  for (int k = 0; k < 1 << dim; ++k) {
    int tile = 0, offset = 0;
    bool at_wall = false;
    for (int a = 0; a < dim; ++a) {
      const int upper = (k >> a) & 1;
      tile += pairs[a]->tile[upper];
      offset += pairs[a]->offset[upper];
      at_wall |= pairs[a]->at_wall[upper];
    }
    stencil.id[k] = at_wall ? Stencil<dim>::wall_sample : table_[tile] * tile_volume<dim> + offset;
  }
  for (int a = 0; a < dim; ++a)
    stencil.weight[a] = pairs[a]->weight;
  return stencil;
}

template <int dim>
Stencil<dim> SampleLattice<dim>::locate(SampleKind kind, const Point<dim>& x) const {
  std::array<Pair, dim> pairs;
  std::array<const Pair*, dim> chosen;
  for (int a = 0; a < dim; ++a) {
    pairs[a] = find_pair(a, a == kind, x[a]);
    chosen[a] = &pairs[a];
  }
  return combine(chosen);
}

template <int dim>
std::array<Stencil<dim>, dim> SampleLattice<dim>::locate_faces(const Point<dim>& x) const {
  std::array<Pair, dim> on_faces, at_centers;
  for (int a = 0; a < dim; ++a) {
    on_faces[a] = find_pair(a, true, x[a]);
    at_centers[a] = find_pair(a, false, x[a]);
  }
  std::array<Stencil<dim>, dim> stencils;
  for (int kind = 0; kind < dim; ++kind) {
    std::array<const Pair*, dim> chosen;
    for (int a = 0; a < dim; ++a)
      chosen[a] = a == kind ? &on_faces[a] : &at_centers[a];
    stencils[kind] = combine(chosen);
  }
  return stencils;
}

}  // namespace lockstep
