#pragma once
#include <vector>

#include "deformable/element_forces.hpp"

namespace lockstep {

struct SurfaceFrame;  // output/frames.hpp

/// Appends for each body the mesh of its elements with their stress, strain and energy. Collective.
template <int dim>
void add_element_frames(const ElementForces<dim>& forces, std::vector<SurfaceFrame>& frames);

}  // namespace lockstep
