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

/// Thickness of the plate that has a closed solid's ratio of volume and surface, of a body as
/// compact as a ball its smallest extent [m]. Local; the same on all ranks.
template <int dim>
double thickness(const SurfaceSnapshot<dim>& surface, int solid);

/// The coupling that `Coupling/Type` = "automatic" stands for: "flux", whose errors are of second
/// order, where each closed solid is not thin for cells of that size [m] and not far lighter
/// than a fluid of that density [kg/m^dim], else "mixed face". Local; the same on all ranks.
template <int dim>
CouplingChoice automatic_coupling(const SurfaceSnapshot<dim>& surface, double spacing,
                                  double density);

}  // namespace lockstep
