#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/errors.hpp"
#include "deformable/elements/shell_elements.hpp"
#include "deformable/mesh/mesh_file.hpp"
#include "deformable/reading/body_start.hpp"
#include "deformable/reading/deformable_parameters.hpp"
#include "geometry/generators.hpp"
#include "geometry/mesh_repair.hpp"
#include "geometry/surface_check.hpp"
#include "motion/list_values.hpp"
#include "parameters/shape_sizes.hpp"

namespace lockstep {

namespace {

/// Stiffness of the springs across an edge over that of the edge's own [1]: chosen, not varied by a
/// page.
constexpr double shear_ratio = 0.5;

const std::vector<ShapeSizes>& cloth_shapes() {
  static const std::vector<ShapeSizes> all{
      {"sheet", {"Size", "Normal"}},  {"bag", {"Size"}},
      {"ball", {"Radius"}},           {"open ball", {"Radius", "Opening Radius"}},
      {"tube", {"Radius", "Length"}}, {"file", {"File"}, mesh_repair_parameters()}};
  return all;
}

template <int dim>
void declare_cloth_geometry(ParameterList& body) {
  ParameterList& list =
      declare_list(body, "Geometry",
                   "The shell, in coordinates of the body: shapes are centred at their origin.");
  std::vector<std::string> axes{"x", "y", "z"};
  axes.resize(dim);
  declare_required_choice(
      list, "Shape", shape_names(cloth_shapes(), dim),
      "sheet: flat. bag: a box without its lid (y is up). ball: a closed sphere "
      "(2D: ring). open ball: a sphere with a round hole at its top (y is up). tube: without "
      "ends, about z (2D: two walls along y). file: what the file holds.");
  declare_optional<ParameterArray<double>>(
      list, "Size", "Extent of a sheet (along \"Normal\" ignored), edges of a bag [m].");
  set_length(list, "Size", dim);
  declare_optional<std::string>(list, "Normal", "Axis that a sheet is normal to.");
  set_choices(list, "Normal", axes);
  declare_optional<double>(list, "Radius", "Radius of ball, open ball and tube [m].");
  declare_optional<double>(list, "Opening Radius", "Radius of the hole of an open ball [m].");
  declare_optional<double>(list, "Length", "Length of a tube [m].");
  declare_optional<std::string>(
      list, "File",
      "Surface mesh: .obj, .off, .msh of Gmsh, .vtk or (3D) .stl; relative to "
      "the folder of the scene.");
  declare_mesh_repair(list);
  declare_optional<double>(list, "Mesh Spacing",
                           "Longest edge of a generated mesh [m]; default one grid cell.");
  for (const char* size : {"Radius", "Opening Radius", "Length", "Mesh Spacing"})
    set_positive(list, size);
}

template <int dim>
SurfaceMesh<dim> make_cloth_mesh(const ParameterList& list, double grid_spacing,
                                 const std::string& name) {
  const auto& shape = list.get<std::string>("Shape");
  check_shape_sizes(list, cloth_shapes(), name);
  const double spacing =
      list.isParameter("Mesh Spacing") ? list.get<double>("Mesh Spacing") : grid_spacing;
  check_mesh_size(list, spacing, dim - 1, name);
  SurfaceMesh<dim> mesh;
  MeshNames names;
  if (shape == "sheet") {
    mesh = plate_surface<dim>(vector_value<dim>(list, "Size"),
                              list.get<std::string>("Normal")[0] - 'x', spacing);
  } else if (shape == "bag") {
    mesh = open_box_surface<dim>(vector_value<dim>(list, "Size"), spacing);
  } else if (shape == "ball") {
    mesh = ball_surface<dim>(list.get<double>("Radius"), spacing);
  } else if (shape == "open ball") {
    mesh = open_ball_surface<dim>(list.get<double>("Radius"), list.get<double>("Opening Radius"),
                                  spacing);
  } else if (shape == "tube") {
    mesh = tube_surface<dim>(list.get<double>("Radius"), list.get<double>("Length"), spacing);
  } else {
    mesh = read_shell_mesh<dim>(list.get<std::string>("File"), names);
    repair_surface(list, mesh, names);
  }
  check_surface(mesh, {name, false, true}, names);
  return mesh;
}

template <int dim>
void add_elements(const ParameterList& list, const SurfaceMesh<dim>& mesh,
                  DeformableBody<dim>& body) {
  const SheetMaterial sheet{list.get<double>("Young's Modulus"),
                            list.get<double>("Poisson's Ratio"), list.get<double>("Thickness"),
                            list.get<double>("Stiffness Damping")};
  const double stretch = 1 + list.get<double>("Pre-Strain");
  const ParameterList& membrane = list.sublist("Membrane");
  if (membrane.get<std::string>("Type") == "mass-spring") {
    body.elements.push_back(membrane_springs<dim>(mesh, sheet, stretch, shear_ratio));
  } else {
    body.elements.push_back(membrane_elements<dim>(mesh, sheet, stretch));
  }
  const auto& bending = list.get<std::string>("Bending");
  if (bending != "none")
    body.elements.push_back(bending_elements<dim>(mesh, sheet, bending == "flat"));
  if (const double tension = list.get<double>("Surface Tension"); tension > 0)
    body.elements.push_back(surface_tension_elements<dim>(mesh, tension));
}

/// Declares what the mass of a sheet is. Its "Thickness" is that of its stiffness, too.
void declare_sheet_mass(ParameterList& list) {
  declare_optional<double>(
      list, "Surface Density",
      "Mass per area as meshed [kg/m^2] (2D: [kg/m]); \"Density\" may take its place. 0: no mass "
      "but that of the fluid lumped on it; then it must be fully implicit, in a scene whose "
      "\"Contact/Type\" is \"none\".");
  set_at_least(list, "Surface Density", 0);
  declare_optional<double>(list, "Density",
                           "Density of the material [kg/m^3] (2D: [kg/m^2]): the mass per area is "
                           "\"Thickness\" times this.");
  set_positive(list, "Density");
}

/// Returns the mass per area as meshed [kg/m^2] (2D: [kg/m]).
double surface_density(const ParameterList& list, const std::string& name) {
  const bool direct = list.isParameter("Surface Density"), by_volume = list.isParameter("Density");
  check_input(!(direct && by_volume),
              "The cloth \"{}\" has both \"Surface Density\" and \"Density\"; leave out one: "
              "\"Thickness\" times \"Density\" takes the place of \"Surface Density\".",
              name);
  check_input(
      direct || by_volume,
      "The cloth \"{}\" has no mass; give \"Surface Density\", or the \"Density\" of what it "
      "is made of.",
      name);
  return direct ? list.get<double>("Surface Density")
                : list.get<double>("Thickness") * list.get<double>("Density");
}

}  // namespace

template <int dim>
ParameterList cloth_parameters() {
  ParameterList list("cloth");
  declare_cloth_geometry<dim>(list);
  declare_required_positive(list, "Young's Modulus", "Young's modulus of the material [Pa].");
  declare_between(
      list, "Poisson's Ratio", 0.3, -0.99, 0.5,
      "Poisson's ratio of the material [1]. Springs in 3D behave like 1/3, whatever is given.");
  declare_required_positive(list, "Thickness",
                            "Thickness of the sheet [m]: membrane stiffness goes with it, bending "
                            "stiffness with its cube.");
  declare_sheet_mass(list);
  ParameterList elements("finite element"), springs("mass-spring");
  declare_typed_sublist(
      list, "Membrane", "Resistance to stretch and shear.",
      {{"finite element", "Constant strain, Hooke's law in the plane.", elements},
       {"mass-spring", "Springs along the edges and, in 3D, across them.", springs}},
      "finite element");
  declare_choice(list, "Bending", "as meshed", {"as meshed", "flat", "none"},
                 "Shape without bending moments: the mesh's own, or a flat one; none: no bending "
                 "stiffness.");
  declare_between(list, "Pre-Strain", 0.0, -0.9, 100.0,
                  "Strain of the mesh against the sheet at rest, in all directions [1]; positive: "
                  "under tension.");
  declare_at_least(list, "Surface Tension", 0.0, 0.0,
                   "Tension besides the elastic stress, whatever the strain [N/m] (2D: [N]).");
  declare_at_least(
      list, "Stretch Limit", 0.0, 0.0,
      "Most that an edge may be longer than at rest [1]: impulses along the edges keep "
      "the step from stretching it further, which takes a \"Surface Density\". 0: no limit.");
  declare_body_start<dim>(list, "fully-implicit");
  return list;
}

template <int dim>
DeformableBody<dim> read_cloth(const std::string& name, const ParameterList& list,
                               double grid_spacing) {
  const SurfaceMesh<dim> mesh = make_cloth_mesh<dim>(list.sublist("Geometry"), grid_spacing, name);
  DeformableBody<dim> body;
  body.name = name;
  body.closed = false;
  body.density = surface_density(list, name);
  add_elements<dim>(list, mesh, body);
  if (const double limit = list.get<double>("Stretch Limit"); limit > 0) {
    body.limited_edges = limited_edges<dim>(mesh.vertices, mesh.simplices,
                                            1 + list.get<double>("Pre-Strain"), limit);
  }
  body.surface = mesh.simplices;
  body.mass_elements.n_corners = dim;
  for (const auto& simplex : mesh.simplices) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = mesh.vertices[simplex[k]];
    body.element_measure.push_back(area_vector<dim>(corners).norm());
    body.mass_elements.nodes.insert(body.mass_elements.nodes.end(), simplex.begin(), simplex.end());
  }
  read_body_start<dim>(list, mesh.vertices, body);
  check_input(
      body.density > 0 || body.integration == TimeIntegration::fully_implicit,
      "The cloth \"{}\" has no mass (\"Surface Density\" is 0), so that no explicit force may "
      "act on it. Set its \"Time Integration\" to fully-implicit, the default.",
      name);
  check_input(body.density > 0 || body.limited_edges.empty(),
              "The cloth \"{}\" has no mass (\"Surface Density\" is 0) that the impulses of a "
              "\"Stretch Limit\" could act on; leave the limit out, or give it a mass.",
              name);
  return body;
}

template ParameterList cloth_parameters<2>();
template ParameterList cloth_parameters<3>();
template DeformableBody<2> read_cloth<2>(const std::string&, const ParameterList&, double);
template DeformableBody<3> read_cloth<3>(const std::string&, const ParameterList&, double);

}  // namespace lockstep
