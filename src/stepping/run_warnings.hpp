#pragma once
#include <vector>

#include "output/progress.hpp"
#include "stepping/report/step_report.hpp"
#include "stepping/step/components.hpp"

namespace lockstep {

/// Warnings of a run about steps that may not be what one wants, most of them once. Local.
template <int dim>
class RunWarnings {
 public:
  /// The step that comes, before the end of the run shortens it, and the one that is wanted where
  /// everything is stable.
  void before_step(long long step, const StepBound& bound, const StepBound& wanted, const Log& log);
  void after_step(long long step, const StepReport<dim>& report, const Components<dim>& components,
                  const Log& log);

 private:
  void warn_of_watches(long long step, const std::vector<WatchedLiquid>& watches,
                       const LiquidFluid<dim>& liquid, const Log& log);
  /// Warns once when a free solid leaves the domain through a periodic side.
  void warn_of_periodic_sides(long long step, const Components<dim>& components, const Log& log);
  void warn_of_volume(long long step, const LiquidReport& liquid, const Log& log);

  int n_short_ = 0;  ///< steps one after the other that are far shorter than wanted
  bool of_viscous_step_ = false, of_stretch_ = false, of_unsettled_ = false, of_contact_ = false,
       of_volume_ = false, of_short_steps_ = false, of_periodic_sides_ = false;
  std::vector<char> of_watch_;
};

}  // namespace lockstep
