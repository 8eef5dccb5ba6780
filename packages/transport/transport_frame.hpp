#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "transport/surface_transport.hpp"
#include "transport/tile_block.hpp"
#include "transport/transport.hpp"

namespace lockstep {

/// Way in which the samples of a tile are advected.
struct TilePlan {
  bool by_strips = false;  ///< short rays, far from inflow sides: first as if no surface was near
  bool near_surface = false;  ///< a surface may be in the way of some
};

/// Data that all fields advected in one step share.
template <int dim>
struct TransportFrame {
  TransportSetting<dim> setting;
  double largest_displacement = 0;  ///< along an axis, over all ranks [cells]
  std::unique_ptr<SampleLattice<dim>> lattice;
  std::unique_ptr<RayTracer<dim>> tracer;
  std::unique_ptr<SurfaceTransport<dim>> near_surface;
  std::unique_ptr<TileBlock<dim>> block;  ///< null if the rays are too long for it
  std::vector<TilePlan> plans;            ///< plans of owned tiles
  InvalidSamples<dim> invalid;

  /// Calls f(id, position in lattice units) for the samples of that kind of an owned tile, within
  /// the cells [begin, end).
  template <typename Function>
  void for_each_sample(SampleKind kind, int tile, const Index<dim>& begin, Index<dim> end,
                       const Function& f) const;
  template <typename Function>
  void for_each_sample(SampleKind kind, int tile, const Function& f) const;
  /// End of the cells along an axis that have samples of that kind.
  int samples_end(SampleKind kind, int axis) const {
    const GridDescription<dim>& description = setting.grid.description();
    return description.n_cells[axis] + (axis == kind && description.store_upper_face[axis] ? 1 : 0);
  }
};

template <int dim>
template <typename Function>
void TransportFrame<dim>::for_each_sample(SampleKind kind, int tile, const Index<dim>& begin,
                                          Index<dim> end, const Function& f) const {
  for (int a = 0; a < dim; ++a) {
    end[a] = std::min(end[a], samples_end(kind, a));
    if (begin[a] >= end[a])
      return;
  }
  const Index<dim>& tile_begin = setting.grid.tile_begin(tile);
  const Point<dim> offset = sample_offset<dim>(kind);
  Index<dim> cell = begin;
  int a = 0;
  while (a < dim) {
    int row = tile * tile_volume<dim> - tile_begin[0];
    Point<dim> x;
    for (int b = 1; b < dim; ++b) {
      row += (cell[b] - tile_begin[b]) << (log_tile_width<dim> * b);
      x[b] = cell[b] + offset[b];
    }
    for (int i = begin[0]; i < end[0]; ++i) {
      x[0] = i + offset[0];
      f(row + i, x);
    }
    for (a = 1; a < dim && ++cell[a] == end[a]; ++a)
      cell[a] = begin[a];
  }
}

template <int dim>
template <typename Function>
void TransportFrame<dim>::for_each_sample(SampleKind kind, int tile, const Function& f) const {
  const Index<dim> begin = setting.grid.tile_begin(tile);
  Index<dim> end = begin;
  for (int& e : end)
    e += tile_width<dim>;
  for_each_sample(kind, tile, begin, end, f);
}

}  // namespace lockstep
