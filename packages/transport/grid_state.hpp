#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "grid/tiled_grid.hpp"

namespace lockstep {

/// Content of a cell, judged at its centre.
enum class CellState : char {
  outside,  ///< beyond the domain
  fluid,    ///< carries a pressure
  solid,    ///< centre inside a closed solid
  air       ///< its pressure is known: air above a free surface, p = 0, or fluid at rest at the
            ///< rim of the stored tiles
};

/// Kind of a face velocity.
enum class FaceState : char {
  inactive,    ///< no fluid on either side
  free,        ///< changed by pressure: interior or open side
  coupled,     ///< closed by the coupling: moves with the solids
  prescribed,  ///< wall or inflow
  extended     ///< in the air near a free surface: extrapolates the velocity of the fluid
};

/// True if fluid has this velocity at the face itself.
inline bool is_wet(FaceState face) {
  return face != FaceState::inactive && face != FaceState::extended;
}
/// True if transport advects the velocity.
inline bool is_carried(FaceState face) {
  return face == FaceState::free || face == FaceState::coupled || face == FaceState::extended;
}

/// State of the samples of a staggered grid at one instant, on all stored cells (owned and ghost):
/// which of them have a value, and which solids are between them.
template <int dim>
struct GridState {
  std::shared_ptr<const SurfaceSnapshot<dim>> surface;
  std::vector<CellState> cells;
  std::array<std::vector<FaceState>, dim> faces;  ///< state of the lower face of each cell
  /// True if surfaces may leave faces partly open (cut cells): cells are then fluid wherever their
  /// centres are. The same on all ranks.
  bool has_cut_cells = false;
  /// Where the fluid of partly open faces is, owned and ghost; their centres may lie in a solid.
  std::array<std::unordered_map<int, Point<dim>>, dim> open_centers;
};

}  // namespace lockstep
