#pragma once
#include <string>

namespace lockstep {

/// The longest step that something allows, and what a run says of it.
struct StepBound {
  double dt = 1e300;     ///< [s]
  std::string reason{};  ///< for the log: "surface tension"
  std::string remedy{};  ///< sentence on how to lift the bound; empty: nothing does
};

inline const StepBound& shorter(const StepBound& a, const StepBound& b) {
  return b.dt < a.dt ? b : a;
}

}  // namespace lockstep
