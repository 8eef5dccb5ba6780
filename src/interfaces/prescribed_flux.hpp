#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// Flux into the fluid of one boundary whose velocity is given: a side of the domain or a
/// prescribed solid.
struct PrescribedFlux {
  std::string name;  ///< for messages: the inflow "x lower"
  /// By face of this rank: a pressure unknown, of any rank, and the volume rate into it [m^dim/s].
  std::vector<std::pair<GlobalIndex, double>> into;
};

// Side interfaces (`side_of`) that let a run say whose motion closed fluid has no room for. What a
// fluid or coupling without them prescribes is left out.

/// Prescribed fluxes through the sides of the domain; a side interface of fluids.
class SideFluxes {
 public:
  virtual ~SideFluxes() = default;
  /// Returns the flux of each side with a prescribed velocity at `time`, also where it is zero
  /// then. Local.
  virtual std::vector<PrescribedFlux> side_fluxes(double time) const = 0;
};

template <int dim>
class SolidSystem;

/// Prescribed fluxes of solids; a side interface of couplings.
template <int dim>
class SolidFluxes {
 public:
  virtual ~SolidFluxes() = default;
  /// Returns the contribution of each prescribed solid of the system to row 1, at the present time,
  /// face by face. Local.
  virtual std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const = 0;
};

}  // namespace lockstep
