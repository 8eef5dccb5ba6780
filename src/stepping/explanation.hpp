#pragma once
#include <string>

#include "stepping/step/paper_step.hpp"

namespace lockstep {

/// Tells what is active in a run, why, and what it costs in memory; `reads_pressure`: the viscous
/// solve does. Collective.
template <int dim>
std::string explanation(Components<dim>& components, PaperStep<dim>& scheme, bool reads_pressure);

}  // namespace lockstep
