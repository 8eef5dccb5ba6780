#pragma once
#include "deformable/mesh/volume_mesh.hpp"

namespace lockstep {

/// Volumes with a thick wall, centred at the origin; `radius` is the outer one, `spacing` [m] the
/// longest edge of the outer surface and of the layers. All throw InputError for impossible sizes.
/// A spherical shell (2D: an annulus) of the exact volume between two exact balls.
template <int dim>
VolumeMesh<dim> hollow_ball_volume(double radius, double thickness, double spacing);

/// 3D: a pipe about z whose section has the exact area. 2D: throws InputError.
template <int dim>
VolumeMesh<dim> tube_volume(double radius, double thickness, double length, double spacing);

}  // namespace lockstep
