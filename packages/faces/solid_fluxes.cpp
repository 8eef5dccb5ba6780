#include "faces/solid_fluxes.hpp"

#include <fmt/format.h>

namespace lockstep {

FluxesOfSolids::FluxesOfSolids(const std::vector<SolidDescription>& solids) {
  for (const SolidDescription& solid : solids) {
    place_.push_back(solid.prescribed ? static_cast<int>(fluxes_.size()) : -1);
    if (solid.prescribed)
      fluxes_.push_back({fmt::format("the solid \"{}\"", solid.name), {}});
  }
}

}  // namespace lockstep
