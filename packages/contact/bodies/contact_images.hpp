#pragma once
#include <vector>

#include "coupling/solid_system.hpp"

namespace lockstep {

/// Images of repeated solids that other solids may touch across periodic sides: each is beside
/// another solid's own place, but for those that are there themselves. Of two repeated solids the
/// second has an image beside the first, so that a pair meets once. None in scenes with solids that
/// deform, whose contacts go by the vertices of all. Local, the same on all ranks.
template <int dim>
std::vector<typename SolidImages<dim>::Image> contact_images(const SolidSystem<dim>& system,
                                                             const SurfaceMesh<dim>& mesh);

}  // namespace lockstep
