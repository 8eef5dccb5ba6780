#pragma once
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The list "View" of a scene: how tools/ draw it. A run checks it and reads nothing of it.
void declare_view(ParameterList& scene, int dim);
/// Throws InputError for a direction that shows nothing.
void check_view(const ParameterList& scene);

}  // namespace lockstep
