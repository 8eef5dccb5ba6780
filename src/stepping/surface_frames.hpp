#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "output/frames.hpp"

namespace lockstep {

/// The surface of each solid for a frame, with the velocity of its last motion.
template <int dim>
std::vector<SurfaceFrame> surface_frames(const SolidSystem<dim>& solids,
                                         const SurfaceSnapshot<dim>& surface);

}  // namespace lockstep
