#include "stepping/step/fluid_transport.hpp"
#include "coupling/solid_totals.hpp"

namespace lockstep {

template <int dim>
void FluidTransport<dim>::freeze() {
  freeze(components_.solids->snapshot());
  components_.fluid->begin_prediction();
}

template <int dim>
void FluidTransport<dim>::freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  system_.freeze(surface);
  frozen_at_rest_ = solids_rest();
}

/// Nothing moves them now, nor has them ready to move.
template <int dim>
bool FluidTransport<dim>::solids_rest() const {
  return !components_.solids->has_unknowns() && largest_surface_speed(*components_.solids) == 0;
}

template <int dim>
bool FluidTransport<dim>::make_room(const StepTime& step) {
  const auto& solids = *components_.solids;
  const bool has_moved = components_.fluid->begin_step(
      step.begin, step.dt, [&solids] { return largest_surface_speed(solids); });
  if (has_moved)
    freeze();
  return has_moved;
}

template <int dim>
void FluidTransport<dim>::begin_prediction() {
  components_.fluid->begin_prediction();
  reset_unseen_faces();
}

template <int dim>
void FluidTransport<dim>::begin_kick(const StepTime& step) {
  components_.fluid->begin_advection_velocity(step.dt);
  reset_unseen_faces();
}

/// A mixed face that no fluid cell sees holds solid velocity, not stale fluid: W V^n, before
/// forces.
template <int dim>
void FluidTransport<dim>::reset_unseen_faces() {
  const auto& volumes = components_.fluid->coupled_volumes();
  GlobalIndex unseen = 0;
  for (const auto& volume : volumes)
    unseen += volume.seen_by_fluid ? 0 : 1;
  if (sum_all(components_.solids->comm(), unseen) == 0)
    return;
  const std::vector<double> solid = components_.coupling->velocity(*components_.solids->velocity());
  std::vector<double> velocity = components_.fluid->coupled_velocity();
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (!volumes[f].seen_by_fluid)
      velocity[f] = solid[f];
  }
  components_.fluid->set_coupled_velocity(velocity);
}

template <int dim>
void FluidTransport<dim>::carry(const StepTime& step) {
  auto& fluid = *components_.fluid;
  const auto& solids = *components_.solids;
  auto before = system_.surface();
  const bool stays =
      frozen_at_rest_ && solids_rest() && (solids.empty() || is_where(solids, *before));
  const auto after = stays || solids.empty() ? before : solids.snapshot(before.get());
  if (after != before)
    before = with_images_of(solids, *after, before);
  const MovingSurface<dim> moving{before, after, [&solids](const SurfacePoint<dim>& point) {
                                    return solids.effective_velocity(point, point.position);
                                  }};
  fluid.advect(step.begin, step.dt, moving);
  {
    ScopedStage stage(timers_, "geometry");
    if (!stays || fluid.geometry_changes())
      freeze(after);
  }
  fluid.populate_uncovered(moving);
  reset_unseen_faces();
}

template class FluidTransport<2>;
template class FluidTransport<3>;

}  // namespace lockstep
