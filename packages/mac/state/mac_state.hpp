#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "grid/tiled_grid.hpp"
#include "mac/domain/cell_state.hpp"

namespace lockstep {

/// Kinds of face velocities.
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

/// The frozen geometry of the fluid at one instant, on all stored cells (owned and ghost).
template <int dim>
struct MacState {
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
