#include "deformable/reading/deformable_parameters.hpp"

#include "base/errors.hpp"
#include "deformable/elements/volume_elements.hpp"
#include "deformable/reading/body_mesh.hpp"
#include "deformable/reading/body_start.hpp"
#include "geometry/surface_check.hpp"

namespace lockstep {

namespace {

/// The sides of elements have no names in the file, their vertices have.
MeshNames names_of_boundary(const MeshNames& volume, const std::vector<int>& vertices) {
  MeshNames names;
  names.file = volume.file;
  names.vertex_word = volume.vertex_word;
  for (const int v : vertices)
    names.vertices.push_back(volume.vertices.empty() ? v : volume.vertices[v]);
  return names;
}

/// Returns the mesh at rest in the orientation of the start, for laws of small rotations, which
/// count from there; other laws see no rotation.
template <int dim>
VolumeMesh<dim> turned_at_start(VolumeMesh<dim> mesh, const ParameterList& list) {
  const Eigen::Matrix<double, dim, dim> rotation = start_rotation<dim>(list);
  for (Point<dim>& x : mesh.vertices)
    x = rotation * x;
  return mesh;
}

/// A hundred times the pressure under the body's own weight: enough for a fall from ten times its
/// size [Pa].
template <int dim>
double holding_stiffness(const VolumeMesh<dim>& mesh, double density, double gravity) {
  Box<dim> box;
  for (const Point<dim>& x : mesh.vertices)
    box.extend(x);
  return 100 * density * gravity * box.sizes().maxCoeff();
}

}  // namespace

template <int dim>
ParameterList deformable_body_parameters(const MaterialRegistry<dim>& materials) {
  ParameterList list("deformable body");
  declare_deformable_geometry<dim>(list);
  declare_typed_sublist(list, "Material", "The elastic law.", materials.schemas(),
                        materials.begin()->name);
  declare_required_positive(list, "Density", "Density at rest [kg/m^3] (2D: [kg/m^2]).");
  declare_at_least(list, "Viscosity", 0.0, 0.0,
                   "Viscosity of the material: shear stress over twice the strain rate [Pa s].");
  declare_body_start<dim>(list, "second-order");
  return list;
}

template <int dim>
DeformableBody<dim> read_deformable_body(const std::string& name, const ParameterList& list,
                                         double grid_spacing, double gravity,
                                         const MaterialRegistry<dim>& materials) {
  MeshNames names = element_names();
  const VolumeMesh<dim> mesh =
      make_body_mesh<dim>(list.sublist("Geometry"), grid_spacing, name, names);
  DeformableBody<dim> body;
  body.name = name;
  body.density = list.get<double>("Density");
  const ParameterList& material = list.sublist("Material");
  auto law = materials.create(material.get<std::string>("Type"), material);
  const LameConstants lame = law->at_rest();
  const double factor = list.get<double>("Stiffness Damping");
  const StrainRateDamping damping{list.get<double>("Viscosity") + factor * lame.mu,
                                  factor * lame.lambda};
  const bool feels_rotations = law->feels_rotations();
  if (list.get<std::string>("Time Integration") == "fully-implicit" ||
      list.get<std::string>("Time Integration") == "second-order")
    law = held_together<dim>(std::move(law), holding_stiffness(mesh, body.density, gravity));
  body.elements.push_back(volume_elements<dim>(feels_rotations ? turned_at_start(mesh, list) : mesh,
                                               std::move(law), damping));
  body.mass_elements = body.elements.back()->corners();
  for (int e = 0; e < static_cast<int>(mesh.elements.size()); ++e)
    body.element_measure.push_back(element_volume(mesh, e));

  BoundarySurface<dim> boundary = extract_surface(mesh, name, names);
  check_surface(boundary.surface, {name, true, false}, names_of_boundary(names, boundary.vertices));
  for (auto simplex : boundary.surface.simplices) {
    for (int& corner : simplex)
      corner = boundary.vertices[corner];
    body.surface.push_back(simplex);
  }
  read_body_start<dim>(list, mesh.vertices, body);
  return body;
}

template ParameterList deformable_body_parameters<2>(const MaterialRegistry<2>&);
template ParameterList deformable_body_parameters<3>(const MaterialRegistry<3>&);
template DeformableBody<2> read_deformable_body<2>(const std::string&, const ParameterList&, double,
                                                   double, const MaterialRegistry<2>&);
template DeformableBody<3> read_deformable_body<3>(const std::string&, const ParameterList&, double,
                                                   double, const MaterialRegistry<3>&);

}  // namespace lockstep
