#pragma once
#include "geometry/mesh_names.hpp"
#include "geometry/surface_mesh.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Changes to the mesh of a file before it is checked.
struct MeshRepair {
  double scale = 1;
  double weld = 0;  ///< [m], after scaling
  bool orient = false;
};

/// Declares "Scale", "Weld" and "Orient", which belong to the shape "file" of a "Geometry".
void declare_mesh_repair(ParameterList& geometry);
MeshRepair read_mesh_repair(const ParameterList& geometry);
/// Names of the parameters of a repair, for `ShapeSizes`.
const std::vector<std::string>& mesh_repair_parameters();

/// Scales the vertices, then merges those closer than `weld` to an earlier one. Simplices that lose
/// a corner go, and so do vertices that none needs any more; `names` follow.
template <int dim, std::size_t n_corners>
void scale_and_weld(const MeshRepair& repair, std::vector<Point<dim>>& vertices,
                    std::vector<std::array<int, n_corners>>& simplices, MeshNames& names);

/// Does to the surface of a file all that a "Geometry" asks for.
template <int dim>
void repair_surface(const ParameterList& geometry, SurfaceMesh<dim>& mesh, MeshNames& names);

}  // namespace lockstep
