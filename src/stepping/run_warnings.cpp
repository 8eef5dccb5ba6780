// Warnings of a run about steps that may not be what one wants.
#include <cmath>

#include "interfaces/liquid.hpp"
#include "stepping/simulation.hpp"

namespace lockstep {

template <int dim>
void Simulation<dim>::warn_of_watches() {
  if (!report_->liquid)
    return;
  const std::vector<WatchedLiquid>& watches = report_->liquid->watches;
  warned_of_watch_.resize(watches.size(), 0);
  for (std::size_t w = 0; w < watches.size(); ++w) {
    if (!std::isnan(watches[w].volume) || warned_of_watch_[w])
      continue;
    warned_of_watch_[w] = 1;
    log_.warning(
        "Step {}: the point of the watch \"{}\" sees the centre of no cell, and no cell is left of "
        "the place that it was in. While that is so it is not watched, and its columns are nan. "
        "Later steps like this one are not reported.",
        step_, components_.fluid->liquid()->watch_names()[w]);
  }
}

template <int dim>
void Simulation<dim>::warn() {
  warn_of_watches();
  const StepReport<dim>& report = *report_;
  if (report.contact_position.n_crossings > 0) {
    log_.warning(
        "Step {}: prescribed solids or pinned nodes press surfaces through each other at {} "
        "places, which contact cannot prevent; let them move less, or less far in a step.",
        step_, report.contact_position.n_crossings);
  }
  constexpr double most_stretch = 0.01;
  if (report.stretch_beyond_limit > most_stretch && !warned_of_stretch_) {
    warned_of_stretch_ = true;
    log_.warning(
        "Step {}: where cloth is to move next, it is {:.2g} times as long as its \"Stretch Limit\" "
        "allows; no more than that was reached by the sweeps over its edges. Shorter steps help, "
        "unless what holds it pulls it apart. Later steps like this one are not reported.",
        step_, 1 + report.stretch_beyond_limit);
  }
  if (!report.is_settled && !warned_of_unsettled_) {
    warned_of_unsettled_ = true;
    log_.warning(
        "Step {}: soft solids move so far that the search for where their implicit forces hold "
        "them ended before they agreed; momentum is kept, the shape is not that of these forces. "
        "Shorter steps help. Later steps like this one are not reported.",
        step_);
  }
  // Up to here the drag of a disc two cells above a wall is right to 0.1 %.
  constexpr double most = 10;
  if (warned_of_viscous_step_ || report.viscous_number <= most * (1 + 1e-9) ||
      components_.solids->largest_surface_speed() == 0)
    return;
  warned_of_viscous_step_ = true;
  log_.warning(
      "Step {}: nu dt/h^2 is {:.3g}. In gaps of a few cells around moving solids, pressure and "
      "drag then lag behind the motion by tens of steps (steady ones are right); with steps "
      "of at most {:.2g} s, where it is {:g}, they follow.",
      step_, report.viscous_number, report.dt * most / report.viscous_number, most);
}

template void Simulation<2>::warn();
template void Simulation<3>::warn();

}  // namespace lockstep
