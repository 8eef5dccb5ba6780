#pragma once
#include <string>

#include "geometry/surface_snapshot.hpp"

namespace lockstep {

/// "Coupling/Type" that leaves the choice to the program.
inline constexpr const char* automatic_coupling_type = "automatic";

/// Name of a coupling, and why a scene has it: half a sentence.
struct CouplingChoice {
  std::string type;
  std::string reason;
};

/// The coupling that `Coupling/Type` = "automatic" stands for: "flux", whose errors are of second
/// order, where each closed solid is not thin for cells of that size [m] and not far lighter
/// than a fluid of that density [kg/m^dim], else "mixed face". Thickness is that of a plate with
/// the solid's ratio of volume and surface; what is as compact as a ball is no plate. Local; the
/// same on all ranks.
template <int dim>
CouplingChoice automatic_coupling(const SurfaceSnapshot<dim>& surface, double spacing,
                                  double density);

}  // namespace lockstep
