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

}  // namespace lockstep
