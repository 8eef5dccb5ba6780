#include "deformable/body_mesh.hpp"

#include "base/errors.hpp"
#include "deformable/mesh/hollow_generators.hpp"
#include "deformable/mesh/mesh_file.hpp"
#include "deformable/mesh/volume_generators.hpp"
#include "geometry/mesh_repair.hpp"
#include "motion/list_values.hpp"
#include "parameters/shape_sizes.hpp"

namespace lockstep {

namespace {

const std::vector<ShapeSizes>& volume_shapes() {
  static const std::vector<ShapeSizes> all{
      {"ball", {"Radius"}},
      {"box", {"Size"}},
      {"cylinder", {"Radius", "Length"}},
      {"torus", {"Radius", "Tube Radius"}, {}, 3},
      {"hollow ball", {"Radius", "Thickness"}},
      {"tube", {"Radius", "Thickness", "Length"}, {}, 3},
      {"spindle", {"Stations", "Half Heights"}, {"Half Widths"}},
      {"file", {"File"}, mesh_repair_parameters()}};
  return all;
}

SpindleShape spindle_of(const ParameterList& list) {
  const auto numbers = [&](const char* parameter) {
    return list.isParameter(parameter) ? list.get<ParameterArray<double>>(parameter).toVector()
                                       : std::vector<double>();
  };
  return {numbers("Stations"), numbers("Half Heights"), numbers("Half Widths")};
}

template <int dim>
VolumeMesh<dim> generate(const ParameterList& list, const std::string& shape, double spacing) {
  const auto number = [&](const char* parameter) { return list.get<double>(parameter); };
  if (shape == "ball")
    return ball_volume<dim>(number("Radius"), spacing);
  if (shape == "box")
    return box_volume<dim>(vector_value<dim>(list, "Size"), spacing);
  if (shape == "cylinder")
    return cylinder_volume<dim>(number("Radius"), number("Length"), spacing);
  if (shape == "spindle")
    return spindle_volume<dim>(spindle_of(list), spacing);
  if (shape == "hollow ball")
    return hollow_ball_volume<dim>(number("Radius"), number("Thickness"), spacing);
  if (shape == "tube") {
    return tube_volume<dim>(number("Radius"), number("Thickness"), number("Length"), spacing);
  }
  return torus_volume<dim>(number("Radius"), number("Tube Radius"), spacing);
}

}  // namespace

template <int dim>
void declare_deformable_geometry(ParameterList& body) {
  ParameterList& list =
      declare_list(body, "Geometry",
                   "The volume at rest, in coordinates of the body: shapes are centred at their "
                   "origin.");
  declare_required_choice(list, "Shape", shape_names(volume_shapes(), dim),
                          "ball, box, cylinder, torus; hollow ball: a ball with a thick wall (2D: "
                          "a ring); tube: a pipe; spindle: along x, as high and wide as told; "
                          "file: a mesh of triangles (2D) or "
                          "tetrahedra (3D).");
  declare_optional<double>(list, "Radius",
                           "Radius of ball and cylinder, of the torus' centre line, and outer "
                           "radius of hollow ball and tube [m].");
  declare_optional<double>(
      list, "Length",
      "Length of cylinder and tube, along z; in 2D a cylinder is a box, along y [m].");
  declare_optional<double>(list, "Thickness", "Thickness of the wall of hollow ball and tube [m].");
  declare_optional<double>(list, "Tube Radius", "Radius of the section of a torus [m].");
  declare_optional<ParameterArray<double>>(list, "Size", "Edges of a box [m].");
  set_length(list, "Size", dim);
  declare_optional<ParameterArray<double>>(list, "Stations",
                                           "Places along a spindle, ascending [m].");
  declare_optional<ParameterArray<double>>(
      list, "Half Heights",
      "Half heights of a spindle at its stations, along y, linear between them [m].");
  declare_optional<ParameterArray<double>>(
      list, "Half Widths",
      "Half widths of a spindle at its stations, along z; its sections are ellipses (3D) [m].");
  declare_optional<std::string>(list, "File",
                                "Mesh: .msh of Gmsh (version 2.2 or 4.1) or legacy .vtk, both "
                                "ASCII; relative to the folder of "
                                "the scene.");
  declare_mesh_repair(list);
  declare_optional<double>(list, "Mesh Spacing",
                           "Longest step of the lattice of a generated mesh [m]; default one grid "
                           "cell.");
  for (const char* size : {"Radius", "Length", "Tube Radius", "Thickness", "Size", "Half Heights",
                           "Half Widths", "Mesh Spacing"})
    set_positive(list, size);
  declare_between(
      list, "Worst Quality", 1e-3, 0.0, 1.0,
      "Least quality of an element that is accepted: 1 for the regular simplex, 0 for a "
      "flat one [1].");
}

template <int dim>
VolumeMesh<dim> make_body_mesh(const ParameterList& geometry, double grid_spacing,
                               const std::string& name, MeshNames& names) {
  const auto& shape = geometry.get<std::string>("Shape");
  check_shape_sizes(geometry, volume_shapes(), name);
  check_input(dim == 3 || !geometry.isParameter("Half Widths"),
              "In \"{}/Geometry\", a spindle in 2D has no \"Half Widths\"; leave them out.", name);
  VolumeMesh<dim> mesh;
  if (shape == "file") {
    mesh = read_volume_mesh<dim>(geometry.get<std::string>("File"), names);
    const MeshRepair repair = read_mesh_repair(geometry);
    scale_and_weld(repair, mesh.vertices, mesh.elements, names);
    if (repair.orient)
      orient_elements(mesh);
  } else {
    const double spacing =
        geometry.isParameter("Mesh Spacing") ? geometry.get<double>("Mesh Spacing") : grid_spacing;
    check_mesh_size(geometry, spacing, dim, name);
    mesh = generate<dim>(geometry, shape, spacing);
  }
  check_volume_mesh(mesh, name, geometry.get<double>("Worst Quality"), names);
  return mesh;
}

template void declare_deformable_geometry<2>(ParameterList&);
template void declare_deformable_geometry<3>(ParameterList&);
template VolumeMesh<2> make_body_mesh<2>(const ParameterList&, double, const std::string&,
                                         MeshNames&);
template VolumeMesh<3> make_body_mesh<3>(const ParameterList&, double, const std::string&,
                                         MeshNames&);

}  // namespace lockstep
