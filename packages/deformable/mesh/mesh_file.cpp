#include "deformable/mesh/mesh_file.hpp"

#include <filesystem>

#include "base/errors.hpp"
#include "deformable/mesh/gmsh_file.hpp"
#include "deformable/mesh/vtk_file.hpp"
#include "geometry/mesh_files.hpp"

namespace lockstep {

namespace {
std::string extension_of(const std::string& file) {
  return std::filesystem::path(file).extension().string();
}
}  // namespace

template <int dim>
VolumeMesh<dim> read_volume_mesh(const std::string& file, MeshNames& names) {
  const std::string extension = extension_of(file);
  check_input(extension == ".msh" || extension == ".vtk",
              "{}: unknown kind of mesh file '{}'; use .msh or .vtk.", file, extension);
  auto read = extension == ".msh" ? read_gmsh<dim, dim + 1>(file) : read_vtk<dim, dim + 1>(file);
  VolumeMesh<dim> mesh;
  mesh.vertices = std::move(read.vertices);
  mesh.elements = std::move(read.simplices);
  names = std::move(read.names);
  return mesh;
}

template <int dim>
SurfaceMesh<dim> read_shell_mesh(const std::string& file, MeshNames& names) {
  const std::string extension = extension_of(file);
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
