#include "mixedface/register_mixed_face.hpp"

#include "mixedface/mixed_face_coupling.hpp"

namespace lockstep {
namespace {

ParameterList valid_parameters() {
  ParameterList list;
  declare_choice(
      list, "Mixed Rule", "voxel", {"voxel", "every cut cell"},
      "Dual cells that move with the solid. 'voxel': those whose two cell centres the surface "
      "separates. 'every cut cell': all that the surface touches (much more added mass).");
  declare_choice(
      list, "Lumping", "diagonal", {"diagonal", "consistent", "paper diagonal"},
      "Lumping of fluid mass on the solid: 'diagonal' row sums for nodes (the paper's choice; "
      "rigid bodies carry their full block), 'consistent' W^T M_F W, 'paper diagonal' the literal "
      "Eqs. 22-24 for rigid bodies, which lose momentum: for comparison.");
  declare_choice(list, "Weights", "barycentric", {"barycentric", "area", "rigid motions"},
                 "W of deformable solids. 'barycentric': a mixed face takes the velocity of the "
                 "surface in its dual cell. 'area': that of the nodes of the triangles there, each "
                 "by the triangle's area in the cell alone (Section 5 to the letter). 'rigid "
                 "motions': carried to the centre of the face by the rotation of the surface "
                 "around, so that a turning body moves the fluid as a rigid one does.");
  declare_choice(
      list, "Fluid Mass", "fluid part", {"fluid part", "whole cell"},
      "Fluid mass of a mixed dual cell: density times the part outside the solids, or times the "
      "whole dual cell.");
  declare(list, "Correct Buoyancy", true,
          "Give closed bodies the exact hydrostatic force of their polyhedra in place of what the "
          "grid makes of it, so that they rest at their draft.");
  return list;
}

MixedFaceOptions options_from(const ParameterList& list) {
  MixedFaceOptions options;
  if (list.get<std::string>("Mixed Rule") == "every cut cell") {
    options.rule = MixedRule::every_cut_cell;
  }
  if (list.get<std::string>("Lumping") == "consistent")
    options.lumping = Lumping::consistent;
  else if (list.get<std::string>("Lumping") == "paper diagonal")
    options.lumping = Lumping::paper_diagonal;
  if (list.get<std::string>("Weights") == "area")
    options.soft_weights = SoftWeights::area;
  else if (list.get<std::string>("Weights") == "rigid motions")
    options.soft_weights = SoftWeights::rigid_motions;
  options.whole_cell_mass = list.get<std::string>("Fluid Mass") == "whole cell";
  options.correct_buoyancy = list.get<bool>("Correct Buoyancy");
  return options;
}

}  // namespace

template <int dim>
void register_mixed_face(Registry<Coupling<dim>>& couplings) {
  couplings.add(
      "mixed face",
      "The paper's coupling: mixed dual cells move with the solid, their fluid is lumped on it.",
      valid_parameters, [](const ParameterList& list) {
        return std::make_unique<MixedFaceCoupling<dim>>(options_from(list));
      });
}

template void register_mixed_face<2>(Registry<Coupling<2>>&);
template void register_mixed_face<3>(Registry<Coupling<3>>&);

}  // namespace lockstep
