#pragma once
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Closed surfaces, outward normals, centred at the origin. `spacing` [m] is the largest edge
/// wanted. 2D: ball is a polygon that has the disc's exact area; 3D: a subdivided icosahedron
/// scaled to the ball's exact volume.
template <int dim>
SurfaceMesh<dim> ball_surface(double radius, double spacing);
template <int dim>
SurfaceMesh<dim> box_surface(const Point<dim>& size, double spacing);
/// Axis along z (3D); in 2D a box of width 2 radius and height `length`.
template <int dim>
SurfaceMesh<dim> cylinder_surface(double radius, double length, double spacing);
/// Axis along z (3D), y (2D); `length` between the centres of the caps.
template <int dim>
SurfaceMesh<dim> capsule_surface(double radius, double length, double spacing);
/// 3D: ring in the xy plane, `radius` of the centre line, `tube` of the section. 2D: throws
/// InputError.
template <int dim>
SurfaceMesh<dim> torus_surface(double radius, double tube, double spacing);
/// Open thin shells: the open box ("boat": no lid on top, y in 2D and 3D is up), a flat plate
/// normal to `axis` of the given size (the entry of `axis` is ignored), and those below.
template <int dim>
SurfaceMesh<dim> open_box_surface(const Point<dim>& size, double spacing);
/// A tube without ends about z (3D), whose section has the exact area; in 2D two walls along y.
template <int dim>
SurfaceMesh<dim> tube_surface(double radius, double length, double spacing);
/// A sphere (2D: an arc) with a round hole of radius `opening` at its top (y is up). The vertices
/// lie on the sphere, the facet in one plane.
template <int dim>
SurfaceMesh<dim> open_ball_surface(double radius, double opening, double spacing);
template <int dim>
SurfaceMesh<dim> plate_surface(const Point<dim>& size, int axis, double spacing);

}  // namespace lockstep
