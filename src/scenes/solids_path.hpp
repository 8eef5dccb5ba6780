#pragma once
#include <string>

namespace lockstep {

/// The list of a scene that holds its solids.
inline const std::string solids_path = "Solids";

}  // namespace lockstep
