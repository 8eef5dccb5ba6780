#pragma once
#include <functional>

#include "geometry/moving_surface.hpp"
#include "transport/grid_state.hpp"
#include "transport/transport.hpp"

namespace lockstep {

/// Result of populating uncovered cells, over all ranks.
struct UncoveredReport {
  GlobalIndex n_invalid = 0;  ///< samples in the fluid that had no value
  GlobalIndex n_left_over =
      0;             ///< invalid samples without a valid one in sight, directly or over others
  int n_fronts = 0;  ///< sweeps until nothing changed
};

/// The grid at t^{n+1}, the surface that has moved over it, and the samples that it has left
/// without a value. References must outlive the call.
template <int dim>
struct UncoveredGrid {
  const TiledGrid<dim>& grid;
  const HaloExchange<dim>& halo;  ///< width 1 or more
  const GridState<dim>& after;
  const MovingSurface<dim>& surface;
  KeptSurface<dim>& kept;
  const InvalidSamples<dim>& invalid;
  /// Weight of a face's velocity in the mean of a neighbour, a mass; empty: all are alike.
  std::function<double(int axis, int face)> weight = {};
};

/// Populates uncovered faces after the geometry of t^{n+1} is set: invalid velocities get the mean
/// of their valid and visible neighbours along the axes, front after front (Guendelman et al.
/// 2005). Faces left over, and faces inside solids, get the velocity of the nearest surface within
/// three cells, or zero. Ghost values of u are set on return. Collective.
template <int dim>
UncoveredReport populate_uncovered_faces(const UncoveredGrid<dim>& uncovered, FaceField<dim>& u);
/// Populates the invalid cells of a scalar; those left over get `ambient`. Collective.
template <int dim>
UncoveredReport populate_uncovered_scalar(const UncoveredGrid<dim>& uncovered, double ambient,
                                          CellField& s);

}  // namespace lockstep
