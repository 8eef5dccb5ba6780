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

const std::vector<MaterialName>& material_names() {
  static const std::vector<MaterialName> all{
      {"corotated", "Linear in the stretch once the rotation is taken out; survives inversion."},
      {"neo-hookean", "Stable neo-Hookean rubber (Smith et al. 2018); survives inversion."},
      {"st venant-kirchhoff", "Linear in Green's strain: large rotations, moderate strains."},
      {"linear", "Small strain: small displacements and rotations only."}};
  return all;
}

template <int dim>
std::unique_ptr<Material<dim>> make_material(const std::string& name, const LameConstants& lame) {
  if (name == "corotated")
    return corotated<dim>(lame);
  if (name == "neo-hookean")
    return neo_hookean<dim>(lame);
  if (name == "st venant-kirchhoff")
    return st_venant_kirchhoff<dim>(lame);
  check_input(name == "linear",
              "There is no material \"{}\"; use corotated, neo-hookean, st venant-kirchhoff or "
              "linear.",
              name);
  return linear_elasticity<dim>(lame);
}

template std::unique_ptr<Material<2>> make_material<2>(const std::string&, const LameConstants&);
template std::unique_ptr<Material<3>> make_material<3>(const std::string&, const LameConstants&);

}  // namespace lockstep
