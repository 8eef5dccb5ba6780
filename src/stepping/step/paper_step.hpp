#pragma once
#include "stepping/step/time_scheme.hpp"

namespace lockstep {

/// A step of Section 7, of first order: solids are moved by what a first solve finds, which is
/// thrown away; a second one finds velocities. Throws as TimeScheme::advance. Collective.
template <int dim>
StepReport<dim> paper_step(StepParts<dim>& parts, const StepTime& step, const StageRunner& run);

}  // namespace lockstep
