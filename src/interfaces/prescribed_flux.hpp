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

}  // namespace lockstep
