#pragma once
#include <string>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// What one thing whose velocity is given (a side, a prescribed solid) drives into the fluid.
struct PrescribedFlux {
  std::string name;  ///< for messages: the inflow "x lower"
  /// By face of this rank: a pressure unknown, of any rank, and the volume rate into it [m^dim/s].
  std::vector<std::pair<GlobalIndex, double>> into;
};

// Side interfaces (`side_of`) that let a run say whose motion closed fluid has no room for. What a
// fluid or coupling without them prescribes is left out.

/// Of a fluid.
class SideFluxes {
 public:
  virtual ~SideFluxes() = default;
  /// What its sides let in at `time`, one by one, whether they do at that time or not. Local.
  virtual std::vector<PrescribedFlux> side_fluxes(double time) const = 0;
};

template <int dim>
class SolidSystem;

/// Of a coupling.
template <int dim>
class SolidFluxes {
 public:
  virtual ~SolidFluxes() = default;
  /// What every prescribed solid of the system alone pushes into row 1, at the present time, face
  /// by face. Local.
  virtual std::vector<PrescribedFlux> solid_fluxes(const SolidSystem<dim>& solids) const = 0;
};

}  // namespace lockstep
