#pragma once
#include "geometry/mesh_names.hpp"
#include "geometry/surface_mesh.hpp"

namespace lockstep {

/// Demands on a surface, and its names in messages.
struct SurfaceDemand {
  std::string name;          ///< name of the solid
  bool closed = true;        ///< it must enclose a volume
  bool can_be_shell = true;  ///< "Thin Shell" would make an open one right
};

/// `check_surface` of a mesh that may come from a file: throws InputError that says how many
/// simplices, facets or parts are wrong, where the first of them is, what the file calls it, and
/// what parameter helps. Of a file it also refuses closed surfaces that cross themselves, and those
/// whose parts face different ways (of nested parts the inner one bounds a hole and must face into
/// it); if all face wrong, all are turned around.
template <int dim>
void check_surface(SurfaceMesh<dim>& mesh, const SurfaceDemand& demand, const MeshNames& names);

}  // namespace lockstep
