#pragma once
#include "coupling/coupled_system.hpp"
#include "output/timers.hpp"
#include "stepping/step/components.hpp"
#include "stepping/step/step_context.hpp"

namespace lockstep {

/// Takes the fluid from the geometry of one time to that of another: freezes the geometry, carries
/// the fluid along u_ADV.
template <int dim>
class FluidTransport {
 public:
  FluidTransport(Components<dim>& components, CoupledSystem<dim>& system, StageTimers& timers)
      : components_(components), system_(system), timers_(timers) {}

  /// Freezes the geometry at the present positions; u* = u^n. Collective.
  void freeze();
  /// Lets the fluid take the cells that a step needs; true if they are others than before, and the
  /// geometry is frozen anew. Collective.
  bool make_room(const StepTime& step);
  /// u* = u^n, where no fluid sees a mixed face W V^n. Collective.
  void begin_prediction();
  /// As `begin_prediction`, with what advection makes of u^n up to the middle of the step, as far
  /// as the fluid knows it. Collective.
  void begin_kick(const StepTime& step);
  /// u* = u^n along the rays of u_ADV, to the present positions of the solids, at which the
  /// geometry is frozen. Collective.
  void carry(const StepTime& step);

 private:
  void freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface);
  bool solids_rest() const;
  void reset_unseen_faces();

  Components<dim>& components_;
  CoupledSystem<dim>& system_;
  StageTimers& timers_;
  bool frozen_at_rest_ = false;  ///< the geometry is that of solids that did not move then
};

}  // namespace lockstep
