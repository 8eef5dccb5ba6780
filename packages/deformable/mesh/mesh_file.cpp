#include "deformable/mesh/mesh_file.hpp"

#include <filesystem>

#include "base/errors.hpp"
#include "deformable/mesh/gmsh_file.hpp"
#include "deformable/mesh/vtk_file.hpp"
#include "geometry/mesh_files.hpp"

namespace lockstep {

namespace {
/// Returns the end of a message about a file without tetrahedra (2D: triangles): how Gmsh makes
/// them, nothing if it cannot.
template <int dim>
std::string how_gmsh_meshes(const std::string& file, const std::string& extension) {
  const std::filesystem::path name = std::filesystem::path(file).filename();
  const std::string from = name.string(), stem = name.stem().string();
  if (is_shape_file(file))
    return fmt::format(", which \"gmsh -{} {} -o {}.msh\" makes", dim, from, stem);
  const bool is_stl = extension == ".stl";
  if (dim == 2 || !(is_stl || extension == ".obj" || extension == ".off" || extension == ".ply"))
    return "";
  const std::string conversion =
      is_stl ? "" : fmt::format(", after \"assimp export {} {}.stl\",", from, stem);
  return fmt::format(
      ", which{} \"gmsh -3 {}.geo -o {}.msh\" makes of a file {}.geo with the line 'Merge "
      "\"{}.stl\"; Surface Loop(1) = {{1}}; Volume(1) = {{1}};'",
      conversion, stem, stem, stem, stem);
}
}  // namespace

template <int dim>
VolumeMesh<dim> read_volume_mesh(const std::string& file, MeshNames& names) {
  const std::string extension = lower_extension(file);
  check_input(extension == ".msh" || extension == ".vtk",
              "{}: unknown kind of mesh file '{}'; use .vtk or .msh{}.", file, extension,
              how_gmsh_meshes<dim>(file, extension));
  auto read = extension == ".msh" ? read_gmsh<dim, dim + 1>(file) : read_vtk<dim, dim + 1>(file);
  VolumeMesh<dim> mesh;
  mesh.vertices = std::move(read.vertices);
  mesh.elements = std::move(read.simplices);
  names = std::move(read.names);
  return mesh;
}

template <int dim>
SurfaceMesh<dim> read_shell_mesh(const std::string& file, MeshNames& names) {
  const std::string extension = lower_extension(file);
  if (extension != ".msh" && extension != ".vtk")
    return read_surface<dim>(file, names);
  auto read = extension == ".msh" ? read_gmsh<dim, dim>(file) : read_vtk<dim, dim>(file);
  SurfaceMesh<dim> mesh;
  mesh.vertices = std::move(read.vertices);
  mesh.simplices = std::move(read.simplices);
  names = std::move(read.names);
  return mesh;
}

template VolumeMesh<2> read_volume_mesh<2>(const std::string&, MeshNames&);
template VolumeMesh<3> read_volume_mesh<3>(const std::string&, MeshNames&);
template SurfaceMesh<2> read_shell_mesh<2>(const std::string&, MeshNames&);
template SurfaceMesh<3> read_shell_mesh<3>(const std::string&, MeshNames&);

}  // namespace lockstep
