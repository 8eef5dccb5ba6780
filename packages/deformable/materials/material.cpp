#include "deformable/materials/material.hpp"

#include "base/errors.hpp"

namespace lockstep {

LameConstants lame_constants(double youngs_modulus, double poisson_ratio) {
  check_input(youngs_modulus > 0, "Young's modulus must be positive, but is {} Pa.",
              youngs_modulus);
  check_input(poisson_ratio > -1 && poisson_ratio < 0.5,
              "Poisson's ratio must lie between -1 and 0.5, but is {}; nearly incompressible is "
              "0.49.",
              poisson_ratio);
  return {youngs_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          youngs_modulus / (2 * (1 + poisson_ratio))};
}

template <int dim>
const std::vector<MaterialKind<dim>>& material_kinds() {
  static const std::vector<MaterialKind<dim>> all{
      {"corotated", "Linear in the stretch once the rotation is taken out; survives inversion.",
       corotated<dim>},
      {"neo-hookean", "Stable neo-Hookean rubber (Smith et al. 2018); survives inversion.",
       neo_hookean<dim>},
      {"st venant-kirchhoff", "Linear in Green's strain: large rotations, moderate strains.",
       st_venant_kirchhoff<dim>},
      {"linear", "Small strain: small displacements and rotations only.", linear_elasticity<dim>}};
  return all;
}

template <int dim>
std::unique_ptr<Material<dim>> make_material(const std::string& name, const LameConstants& lame) {
  std::string names;
  for (const MaterialKind<dim>& kind : material_kinds<dim>()) {
    if (kind.name == name)
      return kind.make(lame);
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw InputError(fmt::format("There is no material \"{}\"; there are {}.", name, names));
}

template const std::vector<MaterialKind<2>>& material_kinds<2>();
template const std::vector<MaterialKind<3>>& material_kinds<3>();
template std::unique_ptr<Material<2>> make_material<2>(const std::string&, const LameConstants&);
template std::unique_ptr<Material<3>> make_material<3>(const std::string&, const LameConstants&);

}  // namespace lockstep
