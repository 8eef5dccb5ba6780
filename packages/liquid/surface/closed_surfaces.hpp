#pragma once
#include <vector>

#include "liquid/surface/free_surface.hpp"

namespace lockstep {

/// A push by a pressure jump on an owned face that the surface crosses.
struct SurfacePush {
  int axis = 0, face = 0;
  double jump = 0;  ///< over a step, upwards along the axis [Pa s]
};

/// Takes from pushes on surfaces that close in themselves what is left of their sum: tension pulls
/// a surface together and moves none as a whole, but computed curvatures of its sides differ, and a
/// drop at rest would drift off. Every face along an axis gives the same jump. Surfaces that meet a
/// side of the domain, a solid or the end of what is stored keep what they have. `is_dry`: of
/// stored cells. Collective.
template <int dim>
void hold_closed_surfaces(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                          const std::vector<char>& is_dry, std::vector<SurfacePush>& pushes);

}  // namespace lockstep
