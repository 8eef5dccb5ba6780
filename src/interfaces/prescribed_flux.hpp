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

template <int dim>
class SolidSystem;

/// A side interface of couplings (`side_of`): lets a run say whose motion closed fluid has no room
/// for, as `FluidDiscretization::side_fluxes` does. What a coupling without it prescribes is left
/// out.
template <int dim>
class SolidFluxes {
 public:
  virtual ~SolidFluxes() = default;
  /// Returns the contribution of each prescribed solid of the system to row 1, at the present time,
  /// face by face. Local.
  virtual std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const = 0;
};

}  // namespace lockstep
