#include "deformable/materials/material_registry.hpp"

namespace lockstep {

ParameterList elastic_constants() {
  ParameterList law("law");
  declare_required_positive(law, "Young's Modulus", "Stiffness in uniaxial stress [Pa].");
  declare_between(law, "Poisson's Ratio", 0.3, -0.99, 0.4999,
                  "Contraction across over stretch along [1]. In 2D strain is plane. Near 0.5 "
                  "linear elements lock: refine, or stay below 0.45.");
  return law;
}

LameConstants read_elastic_constants(const ParameterList& material) {
  return lame_constants(material.get<double>("Young's Modulus"),
                        material.get<double>("Poisson's Ratio"));
}

template <int dim>
void register_materials(MaterialRegistry<dim>& materials) {
  const auto add = [&materials](const char* name, const char* documentation,
                                std::unique_ptr<Material<dim>> (*make)(const LameConstants&)) {
    materials.add(name, documentation, elastic_constants,
                  [make](const ParameterList& list) { return make(read_elastic_constants(list)); });
  };
  add("corotated", "Linear in the stretch once the rotation is taken out; survives inversion.",
      corotated<dim>);
  add("neo-hookean", "Stable neo-Hookean rubber (Smith et al. 2018); survives inversion.",
      neo_hookean<dim>);
  add("st venant-kirchhoff", "Linear in Green's strain: large rotations, moderate strains.",
      st_venant_kirchhoff<dim>);
  add("linear", "Small strain: small displacements and rotations only.", linear_elasticity<dim>);
}

template <int dim>
const MaterialRegistry<dim>& shipped_materials() {
  static const MaterialRegistry<dim> all = [] {
    MaterialRegistry<dim> materials("material");
    register_materials<dim>(materials);
    return materials;
  }();
  return all;
}

template void register_materials<2>(MaterialRegistry<2>&);
template void register_materials<3>(MaterialRegistry<3>&);
template const MaterialRegistry<2>& shipped_materials<2>();
template const MaterialRegistry<3>& shipped_materials<3>();

}  // namespace lockstep
