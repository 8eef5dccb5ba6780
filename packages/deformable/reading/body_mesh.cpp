#include "deformable/reading/body_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "deformable/mesh/hollow_generators.hpp"
#include "deformable/mesh/mesh_file.hpp"
#include "deformable/mesh/volume_generators.hpp"
#include "geometry/mesh_repair.hpp"
#include "motion/list_values.hpp"
#include "parameters/shape_sizes.hpp"

namespace lockstep {

namespace {

/// Least quality of an element that is accepted: 1 for the regular simplex, 0 for a flat one [1].
/// Chosen so that meshes of other programs are taken unless an element is all but flat; not varied
/// by a page.
constexpr double worst_quality = 1e-3;

const std::vector<ShapeSizes>& volume_shapes() {
  static const std::vector<ShapeSizes> all{{"ball", {"Radius"}},
                                           {"box", {"Size"}},
                                           {"cylinder", {"Radius", "Length"}},
                                           {"torus", {"Radius", "Tube Radius"}, {}, 3},
                                           {"hollow ball", {"Radius", "Thickness"}},
                                           {"tube", {"Radius", "Thickness", "Length"}, {}, 3},
                                           {"spindle", {"Sections"}},
                                           {"file", {"File"}, mesh_repair_parameters()}};
  return all;
}

template <int dim>
SpindleShape spindle_of(const ParameterList& list) {
  const auto& numbers = list.get<ParameterArray<double>>("Sections");
  check_input(
      numbers.size() % dim == 0,
      "\"Sections\" of a spindle has {} numbers; it takes {} a section: its place along x, half "
      "height{}.",
      numbers.size(), dim, dim == 2 ? "" : " and half width");
  SpindleShape shape;
  for (int i = 0; i < numbers.size(); i += dim) {
    shape.stations.push_back(numbers[i]);
    shape.half_heights.push_back(numbers[i + 1]);
    check_input(numbers[i + 1] > 0 && numbers[i + dim - 1] > 0,
                "\"Sections\" of a spindle: half heights and half widths must be greater than 0.");
    if (dim == 3)
      shape.half_widths.push_back(numbers[i + 2]);
  }
  return shape;
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
    return spindle_volume<dim>(spindle_of<dim>(list), spacing);
  if (shape == "hollow ball")
    return hollow_ball_volume<dim>(number("Radius"), number("Thickness"), spacing);
  if (shape == "tube") {
    return tube_volume<dim>(number("Radius"), number("Thickness"), number("Length"), spacing);
  }
  return torus_volume<dim>(number("Radius"), number("Tube Radius"), spacing);
}

/// Linear elements are too stiff in bending: with 1, 2, 4 and 8 across a beam by a factor of 4 and
/// by 75, 19 and 5 % (beams_test.cpp). In space their number grows with the third power.
template <int dim>
constexpr int least_elements_across = dim == 2 ? 8 : 4;

/// Smallest extent of a generated shape: the thickness of a wall, where it has one [m].
template <int dim>
double thinnest_extent(const ParameterList& list, const std::string& shape) {
  const auto number = [&](const char* parameter) { return list.get<double>(parameter); };
  if (shape == "box")
    return vector_value<dim>(list, "Size").minCoeff();
  if (shape == "hollow ball" || shape == "tube")
    return number("Thickness");
  if (shape == "torus")
    return 2 * number("Tube Radius");
  if (shape == "cylinder")
    return std::min(2 * number("Radius"), number("Length"));
  if (shape == "ball")
    return 2 * number("Radius");
  const SpindleShape spindle = spindle_of<dim>(list);
  const auto thickest = [](const std::vector<double>& halves) {
    return 2 * *std::max_element(halves.begin(), halves.end());
  };
  return dim == 2 ? thickest(spindle.half_heights)
                  : std::min(thickest(spindle.half_heights), thickest(spindle.half_widths));
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
  declare_optional<ParameterArray<double>>(
      list, "Sections",
      dim == 2 ? "Of a spindle, one after the other [m]: place along x, ascending, and half height "
                 "along y; straight between them."
               : "Of a spindle, one after the other [m]: place along x, ascending, half height "
                 "along y and half width along z of an ellipse; straight between them.");
  declare_optional<std::string>(list, "File",
                                "Mesh: .msh of Gmsh (version 2.2 or 4.1, as \"gmsh -3 hull.step -o "
                                "hull.msh\" writes it) or legacy .vtk, both ASCII; relative to the "
                                "folder of the scene.");
  declare_mesh_repair(list);
  declare_optional<double>(list, "Mesh Spacing",
                           fmt::format("Longest step of the lattice of a generated mesh [m]; "
                                       "default one grid cell, but at most 1/{} of the shape's "
                                       "smallest extent. Linear elements are too stiff in "
                                       "bending: with 1, 2, 4 and 8 of them across a beam by a "
                                       "factor of 4 and by 75, 19 and 5 %.",
                                       least_elements_across<dim>));
  for (const char* size : {"Radius", "Length", "Tube Radius", "Thickness", "Size", "Mesh Spacing"})
    set_positive(list, size);
}

template <int dim>
VolumeMesh<dim> make_body_mesh(const ParameterList& geometry, double grid_spacing,
                               const std::string& name, MeshNames& names) {
  const auto& shape = geometry.get<std::string>("Shape");
  check_shape_sizes(geometry, volume_shapes(), name);
  VolumeMesh<dim> mesh;
  if (shape == "file") {
    mesh = read_volume_mesh<dim>(geometry.get<std::string>("File"), names);
    const MeshRepair repair = read_mesh_repair(geometry);
    scale_and_weld(repair, mesh.vertices, mesh.elements, names);
    if (repair.orient)
      orient_elements(mesh);
  } else {
    const double spacing = geometry.isParameter("Mesh Spacing")
                               ? geometry.get<double>("Mesh Spacing")
                               : std::min(grid_spacing, thinnest_extent<dim>(geometry, shape) /
                                                            least_elements_across<dim>);
    check_mesh_size(geometry, spacing, dim, name);
    mesh = generate<dim>(geometry, shape, spacing);
  }
  check_volume_mesh(mesh, name, worst_quality, names);
  return mesh;
}

template void declare_deformable_geometry<2>(ParameterList&);
template void declare_deformable_geometry<3>(ParameterList&);
template VolumeMesh<2> make_body_mesh<2>(const ParameterList&, double, const std::string&,
                                         MeshNames&);
template VolumeMesh<3> make_body_mesh<3>(const ParameterList&, double, const std::string&,
                                         MeshNames&);

}  // namespace lockstep
