#pragma once
#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// Volume [m^dim] of the closed solids inside `box`, by exact clipping: the flux of the vector
/// field (x - c) e_axis through the clipped surface plus the wetted part of the box sides.
/// Overlapping solids are not counted twice beyond the box volume. Zero for shells.
template <int dim>
double solid_volume_in_box(const SurfaceSnapshot<dim>& surface, const Box<dim>& box);

}  // namespace lockstep
