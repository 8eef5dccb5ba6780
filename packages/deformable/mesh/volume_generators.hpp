#pragma once
#include "deformable/mesh/volume_mesh.hpp"

namespace lockstep {

/// Volume meshes centred at the origin; `spacing` [m] is the longest step of the lattice they are
/// made of (diagonals are longer). All throw InputError for impossible sizes.
/// A box: every cube of a lattice is cut into Kuhn simplices, mirrored from cube to cube so that no
/// direction is preferred.
template <int dim>
VolumeMesh<dim> box_volume(const Point<dim>& size, double spacing);

/// A disc from a hexagon, a ball from an icosahedron, whose cones from the centre are subdivided
/// and blown up; scaled to the exact area or volume.
template <int dim>
VolumeMesh<dim> ball_volume(double radius, double spacing);

/// A circular cylinder along z (3D), in 2D a box of width 2 radius and height `length`. The section
/// has the exact area.
template <int dim>
VolumeMesh<dim> cylinder_volume(double radius, double length, double spacing);

/// 3D: a ring in the xy plane, `radius` of the centre line, `tube` of the section; exact volume.
/// 2D: throws InputError.
template <int dim>
VolumeMesh<dim> torus_volume(double radius, double tube, double spacing);

/// Heights and widths of a body along x at some places of its length, linear between them.
struct SpindleShape {
  std::vector<double> stations;                   ///< ascending, two or more [m]
  std::vector<double> half_heights, half_widths;  ///< along y and, in 3D, z [m]
};
/// A body with elliptic sections, in 2D a strip: a fish, a hull. Sections have the exact area.
template <int dim>
VolumeMesh<dim> spindle_volume(const SpindleShape& shape, double spacing);

}  // namespace lockstep
