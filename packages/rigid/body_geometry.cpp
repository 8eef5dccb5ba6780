#include "rigid/body_geometry.hpp"

#include "base/errors.hpp"
#include "geometry/generators.hpp"
#include "geometry/mesh_files.hpp"
#include "geometry/mesh_repair.hpp"
#include "geometry/surface_check.hpp"
#include "motion/list_values.hpp"
#include "parameters/shape_sizes.hpp"

namespace lockstep {

namespace {

const std::vector<ShapeSizes>& shapes() {
  static const std::vector<ShapeSizes> all{{"ball", {"Radius"}},
                                           {"box", {"Size"}},
                                           {"cylinder", {"Radius", "Length"}},
                                           {"capsule", {"Radius", "Length"}},
                                           {"torus", {"Radius", "Tube Radius"}, {}, 3},
                                           {"open box", {"Size"}},
                                           {"plate", {"Size", "Normal"}},
                                           {"file", {"File"}, mesh_repair_parameters()}};
  return all;
}

template <int dim>
SurfaceMesh<dim> make_surface(const ParameterList& list, const std::string& shape, double spacing,
                              MeshNames& names) {
  const auto size = [&] { return vector_value<dim>(list, "Size"); };
  const auto number = [&](const char* parameter) { return list.get<double>(parameter); };
  if (shape == "ball")
    return ball_surface<dim>(number("Radius"), spacing);
  if (shape == "box")
    return box_surface<dim>(size(), spacing);
  if (shape == "cylinder")
    return cylinder_surface<dim>(number("Radius"), number("Length"), spacing);
  if (shape == "capsule")
    return capsule_surface<dim>(number("Radius"), number("Length"), spacing);
  if (shape == "torus")
    return torus_surface<dim>(number("Radius"), number("Tube Radius"), spacing);
  if (shape == "open box")
    return open_box_surface<dim>(size(), spacing);
  if (shape == "plate")
    return plate_surface<dim>(size(), list.get<std::string>("Normal")[0] - 'x', spacing);
  SurfaceMesh<dim> mesh = read_surface<dim>(list.get<std::string>("File"), names);
  repair_surface(list, mesh, names);
  return mesh;
}

}  // namespace

template <int dim>
void declare_geometry(ParameterList& body) {
  ParameterList& list =
      declare_list(body, "Geometry",
                   "The surface, in coordinates of the body: shapes are centred at their origin.");
  std::vector<std::string> axes{"x", "y", "z"};
  axes.resize(dim);
  declare_required_choice(list, "Shape", shape_names(shapes(), dim),
                          "ball, box, capsule, cylinder, torus: volumes. open box (no lid on top, "
                          "y is up), plate: thin "
                          "shells. file: what the file holds.");
  declare_optional<double>(
      list, "Radius", "Radius of ball, capsule and cylinder, and of the torus' centre line [m].");
  declare_optional<double>(list, "Length",
                           "Length of a cylinder (along z; in 2D it is a box, along y), and of a "
                           "capsule between the centres of its caps [m].");
  declare_optional<double>(list, "Tube Radius", "Radius of the section of a torus [m].");
  declare_optional<ParameterArray<double>>(
      list, "Size", "Edges of box and open box, extent of a plate (along \"Normal\" ignored) [m].");
  set_length(list, "Size", dim);
  declare_optional<std::string>(list, "Normal", "Axis that a plate is normal to.");
  set_choices(list, "Normal", axes);
  declare_optional<std::string>(list, "File",
                                "Surface mesh: .obj, .off or (3D) .stl; relative to the folder of "
                                "the scene. Of PLY, glTF and DAE \"assimp "
                                "export hull.dae hull.stl\" makes one.");
  declare_mesh_repair(list);
  for (const char* size : {"Radius", "Length", "Tube Radius"})
    set_positive(list, size);
  declare_optional<double>(list, "Mesh Spacing",
                           "Longest edge of a generated surface [m]; default 0.7 grid cells.");
  set_positive(list, "Mesh Spacing");
  declare(list, "Thin Shell", false,
          "Take a closed surface as a thin shell with fluid on both sides.");
}

template <int dim>
BodyGeometry<dim> make_body_geometry(const ParameterList& geometry, double grid_spacing,
                                     const std::string& name) {
  const auto& shape = geometry.get<std::string>("Shape");
  check_shape_sizes(geometry, shapes(), name);
  const double spacing = geometry.isParameter("Mesh Spacing") ? geometry.get<double>("Mesh Spacing")
                                                              : 0.7 * grid_spacing;
  const bool open = shape == "open box" || shape == "plate";
  check_mesh_size(geometry, spacing, dim - 1, name);
  BodyGeometry<dim> body;
  MeshNames names;
  body.surface = make_surface<dim>(geometry, shape, spacing, names);
  body.closed = !open && !geometry.get<bool>("Thin Shell");
  check_surface(body.surface, {name, body.closed, true}, names);
  return body;
}

template void declare_geometry<2>(ParameterList&);
template void declare_geometry<3>(ParameterList&);
template BodyGeometry<2> make_body_geometry<2>(const ParameterList&, double, const std::string&);
template BodyGeometry<3> make_body_geometry<3>(const ParameterList&, double, const std::string&);

}  // namespace lockstep
