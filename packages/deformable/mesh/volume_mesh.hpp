#pragma once
#include <array>
#include <string>
#include <vector>

#include "geometry/mesh_names.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// A simplicial volume: triangles in 2D (counterclockwise), tetrahedra in 3D (positive volume: the
/// fourth corner lies on the side of the first three's right-hand normal).
template <int dim>
struct VolumeMesh {
  using Element = std::array<int, dim + 1>;
  std::vector<Point<dim>> vertices;  ///< [m]
  std::vector<Element> elements;
};

/// Names of a generated mesh, for messages.
inline MeshNames element_names() {
  MeshNames names;
  names.simplex_word = "element";
  return names;
}

/// Signed volume [m^dim] of an element.
template <int dim>
double element_volume(const VolumeMesh<dim>& mesh, int element);

/// Shape of an element [1]: 1 for the regular simplex, 0 for a flat one, negative if inverted.
/// volume / (root mean square edge)^dim, scaled.
template <int dim>
double element_quality(const VolumeMesh<dim>& mesh, int element);

/// Sum of the elements' volumes [m^dim].
template <int dim>
double mesh_volume(const VolumeMesh<dim>& mesh);

/// Checks a mesh from a file: throws InputError naming the first bad element, and how many there
/// are, if a corner is missing, a vertex is not finite or belongs to no element, or an element's
/// quality is below `worst_quality`. A mesh whose every element is inverted is turned around; a
/// mixture is an error. `name` is used in the message, with what the file calls things.
template <int dim>
void check_volume_mesh(VolumeMesh<dim>& mesh, const std::string& name, double worst_quality = 1e-4,
                       const MeshNames& names = element_names());

/// The boundary of a volume mesh.
template <int dim>
struct BoundarySurface {
  SurfaceMesh<dim> surface;   ///< outward normals; only the vertices that it needs
  std::vector<int> vertices;  ///< number of each of its vertices in the volume mesh
};

/// The sides that belong to one element only. Throws InputError naming the elements if more than
/// two share a side.
template <int dim>
BoundarySurface<dim> extract_surface(const VolumeMesh<dim>& mesh, const std::string& name,
                                     const MeshNames& names = element_names());

/// Turns elements of negative volume around.
template <int dim>
void orient_elements(VolumeMesh<dim>& mesh);

}  // namespace lockstep
