#pragma once
#include "deformable/elements/element_group.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// A thin sheet of isotropic material. In 2D it is long in the third direction (plane strain).
struct SheetMaterial {
  double youngs_modulus = 0;  ///< [Pa]
  double poisson_ratio = 0;   ///< [1]
  double thickness = 0;       ///< [m]
  double damping = 0;         ///< Rayleigh's factor of the stiffness at rest [s]
};

/// Constant-strain membrane of a sheet: Green's strain of the surface and Hooke's law in the plane.
/// The mesh is the sheet stretched by `stretch` [1]: with more than one it is under tension.
template <int dim>
std::unique_ptr<ElementGroup<dim>> membrane_elements(const SurfaceMesh<dim>& mesh,
                                                     const SheetMaterial& sheet, double stretch);

/// Membrane of springs with the stiffness of the sheet: one along each edge, of the stiffness of
/// the area beside it (Van Gelder 1998), and in 3D one across each edge between the corners
/// opposite to it, of `shear_ratio` times that stiffness, which resists shear. In 2D edges are the
/// segments.
template <int dim>
std::unique_ptr<ElementGroup<dim>> membrane_springs(const SurfaceMesh<dim>& mesh,
                                                    const SheetMaterial& sheet, double stretch,
                                                    double shear_ratio);

/// Springs of given ends: `stiffness` [N/m] and rest length [m]; zero makes them linear.
/// `damping` is Rayleigh's factor [s], for the motion along the spring.
struct Spring {
  std::array<int, 2> corners;
  double stiffness = 0, length = 0;
};
template <int dim>
std::unique_ptr<ElementGroup<dim>> springs(const std::vector<Spring>& all, double damping);

/// Bending: energy k/2 (angle - angle at rest)^2 at every inner vertex (2D) or edge (3D), with
/// k = D / length between the middles of the segments, or D edge^2 / (area of both triangles);
/// D = E t^3 / (12 (1 - nu^2)) [N m]. In 3D that is the cylindrical bending of a regular mesh.
/// With `flat`, the angle at rest is zero; else it is the mesh's own.
template <int dim>
std::unique_ptr<ElementGroup<dim>> bending_elements(const SurfaceMesh<dim>& mesh,
                                                    const SheetMaterial& sheet, bool flat);

/// Constant tension [N/m], whatever the strain: energy tension times area.
template <int dim>
std::unique_ptr<ElementGroup<dim>> surface_tension_elements(const SurfaceMesh<dim>& mesh,
                                                            double tension);

}  // namespace lockstep
