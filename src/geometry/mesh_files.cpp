#include "geometry/mesh_files.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "geometry/file_formats.hpp"
#include "geometry/unused_vertices.hpp"

namespace lockstep {

namespace {

bool is_one_of(const std::vector<std::string>& extensions, const std::string& extension) {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// Returns the end of a message: the command of another program that makes an STL file of this one,
/// nothing if none is known.
std::string command_for_stl(const std::string& file, const std::string& extension) {
  const std::filesystem::path name = std::filesystem::path(file).filename();
  const std::string from = name.string(),
                    to = std::filesystem::path(name).replace_extension(".stl").string();
  if (is_one_of({".ply", ".gltf", ".glb", ".dae", ".fbx", ".3ds", ".3mf", ".x3d"}, extension))
    return fmt::format(", which \"assimp export {} {}\" makes", from, to);
  if (is_shape_file(file))
    return fmt::format(", which \"gmsh -2 {} -o {}\" makes", from, to);
  return extension == ".msh" ? fmt::format(", which \"gmsh -0 {} -o {}\" makes", from, to) : "";
}

template <int dim>
SurfaceMesh<dim> read_by_extension(const std::string& file, const std::string& extension,
                                   MeshNames& names) {
  if (extension == ".obj")
    return read_obj<dim>(file, names);
  if (extension == ".off")
    return read_off<dim>(file, names);
  if constexpr (dim == 3) {
    if (extension == ".stl")
      return read_stl(file, names);
  } else {
    check_input(extension != ".stl",
                "{}: an STL file holds triangles, but a 2D surface consists of segments; use .obj "
                "or .off.",
                file);
  }
  throw InputError(fmt::format("{}: unknown kind of surface file '{}'; use .obj, .off or {}.", file,
                               extension,
                               dim == 3 ? ".stl" + command_for_stl(file, extension) : "(3D) .stl"));
}

}  // namespace

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

bool is_shape_file(const std::string& file) {
  return is_one_of({".geo", ".step", ".stp", ".iges", ".igs", ".brep"}, lower_extension(file));
}

template <int dim>
SurfaceMesh<dim> read_surface(const std::string& file, MeshNames& names) {
  const std::string refusal = refusal_to_read(file);
  check_input(refusal.empty(),
              "{}: cannot open this surface file ({}); check its path and permissions.", file,
              refusal);
  names = MeshNames();
  names.file = file;
  SurfaceMesh<dim> mesh = read_by_extension<dim>(file, lower_extension(file), names);
  check_input(!mesh.simplices.empty(), "{}: the file holds no {}.", file,
              dim == 2 ? "segments" : "triangles");
  drop_unused_vertices(mesh.vertices, mesh.simplices, names.vertices);
  return mesh;
}

template <int dim>
SurfaceMesh<dim> read_surface(const std::string& file) {
  MeshNames names;
  return read_surface<dim>(file, names);
}

template SurfaceMesh<2> read_surface<2>(const std::string&, MeshNames&);
template SurfaceMesh<3> read_surface<3>(const std::string&, MeshNames&);
template SurfaceMesh<2> read_surface<2>(const std::string&);
template SurfaceMesh<3> read_surface<3>(const std::string&);

}  // namespace lockstep
