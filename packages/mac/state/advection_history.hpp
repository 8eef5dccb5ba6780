#pragma once
#include <vector>

#include "grid/halo_exchange.hpp"
#include "staggered/state/stored_fields.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

/// Change that advection made of the velocities in the last step, over its length [m/s^2]: on faces
/// that are free before and after it, zero elsewhere. With half of it u^n and the first kick of a
/// step are those of its middle, free of divergence with the pressure that bends the way of the
/// fluid. Ghost faces included. Local.
template <int dim>
class AdvectionHistory {
 public:
  explicit AdvectionHistory(const TiledGrid<dim>& grid);

  /// u += scale times the change [m/s^2] of the last step.
  void add(double scale, FaceField<dim>& u) const;
  /// Advection takes `before`, on faces of `state`, as long as dt.
  void begin(FaceField<dim> before, const GridState<dim>& state, double dt);
  /// It made `after` of it, on faces of `state`.
  void end(const FaceField<dim>& after, const GridState<dim>& state);

  /// Fields that a restart needs. Valid while this is neither moved nor copied.
  std::vector<StoredField> fields() { return {stored_faces<dim>("advection_rate", rate_)}; }

 private:
  FaceField<dim> rate_;                            ///< [m/s^2]
  FaceField<dim> before_;                          ///< [m/s]
  std::array<std::vector<FaceState>, dim> faces_;  ///< then
  double dt_ = 0;                                  ///< [s]
};

}  // namespace lockstep
