#pragma once
#include <string>

#include "stepping/step/time_scheme.hpp"

namespace lockstep {

/// Says what keeps a scene from steps of `kick_drift_kick`, a sentence without its end: deforming
/// solids or trapped gas. Empty: nothing. Local.
template <int dim>
std::string hindrance_to_kick_drift_kick(const Components<dim>& components);

/// A step of second order for rigid solids and the fluid around them: both of the coupled solves
/// are kept, each half of the step's forces where the bodies then are. The same solves as those of
/// `paper_step`, but for F2, which finds nothing to do where bodies go on as the first solve has
/// it. Throws as TimeScheme::advance. Collective.
template <int dim>
StepReport<dim> kick_drift_kick(StepParts<dim>& parts, const StepTime& step,
                                const StageRunner& run);

}  // namespace lockstep
