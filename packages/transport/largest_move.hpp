#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/moving_surface.hpp"

namespace lockstep {

/// Returns the largest displacement of a vertex of the solids over the step [m], 0 without solids
/// or where they are at one place only.
template <int dim>
double largest_move(const MovingSurface<dim>& surface) {
  if (!surface.before || !surface.after)
    return 0;
  const auto& from = surface.before->mesh().vertices;
  const auto& to = surface.after->mesh().vertices;
  double largest = 0;
  for (std::size_t v = 0; v < from.size(); ++v)
    largest = std::max(largest, (to[v] - from[v]).squaredNorm());
  return std::sqrt(largest);
}

}  // namespace lockstep
