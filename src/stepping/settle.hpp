#pragma once
#include <functional>

#include "output/progress.hpp"
#include "stepping/scene.hpp"

namespace lockstep {

/// Moves free solids to where they rest in the water of the start, which is still then: no waves,
/// no inflow, no sources. `components` are those of `scene`, at their start and in no TimeScheme
/// yet; `build` makes more of them, of this scene or a still one, whose water is filled in around
/// solids that were moved. Tells where each went. Throws InputError for scenes without gravity, or
/// of rigid solids with more than `most_free` coordinates; SolveError where nothing comes to rest.
/// Collective.
///
/// Rigid solids and joints: Newton's method on the accelerations of all free coordinates from rest,
/// each those of a step. Their derivatives are differences. It goes down, never to an equilibrium
/// from which a body would fall. With soft solids, all go down in energy together.
template <int dim>
void settle(const std::function<Components<dim>(const ParameterList&)>& build,
            const ParameterList& scene, const SceneOptions& options, Components<dim>& components,
            const Log& log);

}  // namespace lockstep
