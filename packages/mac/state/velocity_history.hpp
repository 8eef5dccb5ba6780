#pragma once
#include <vector>

#include "grid/halo_exchange.hpp"
#include "staggered/state/stored_fields.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

/// Rate of change of velocities in the last step, which makes advection second order in time: of
/// faces that stay free, or that sides of the domain prescribe [m/s^2]. Zero elsewhere, and in
/// steps whose change may be an impulse: the first one, and those in which a boundary condition
/// jumps. Without solids u + dt/2 du/dt is as free of divergence as u^n and u^{n-1} were. Ghost
/// faces included. Local.
template <int dim>
class VelocityHistory {
 public:
  explicit VelocityHistory(const TiledGrid<dim>& grid);

  /// Extrapolates u^n to the middle of a step: u += dt/2 du/dt.
  void extrapolate(double dt, FaceField<dim>& u) const { add(dt / 2, rate_, u); }
  /// u += scale a, with a the acceleration by pressure, forces and viscosity in the last step
  /// [m/s^2]. The trapezoidal rule along a ray from x_d to x is
  ///   u* = (u^n + dt/2 a)(x_d) + dt/2 a^{n+1}(x);
  /// since the rest of the step brings the whole of dt a^{n+1}, half of it is taken off at once.
  void add_acceleration(double scale, FaceField<dim>& u) const { add(scale, acceleration_, u); }

  void set_advected(const FaceField<dim>& u) { advected_ = u; }
  /// After a step of dt from `before` to `after`; `jumped`: its change was an impulse.
  void accept(const FaceField<dim>& before, const FaceField<dim>& after,
              const GridState<dim>& state, double dt, bool jumped = false);

  /// Fields that a restart needs. Valid while this is neither moved nor copied.
  std::vector<StoredField> fields() {
    return {stored_faces<dim>("acceleration", acceleration_), stored_faces<dim>("rate", rate_),
            stored_faces<dim>("free", free_)};
  }

 private:
  static void add(double scale, const FaceField<dim>& change, FaceField<dim>& u);

  FaceField<dim> acceleration_, rate_;  ///< [m/s^2]
  FaceField<dim> advected_;             ///< velocity of the present step [m/s]
  FaceField<dim> free_;  ///< 1 on faces that were free or prescribed at the end of the last step
};

}  // namespace lockstep
