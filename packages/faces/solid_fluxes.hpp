#pragma once
#include <vector>

#include "interfaces/fluid.hpp"
#include "interfaces/prescribed_flux.hpp"

namespace lockstep {

/// Collects what prescribed solids push through coupled volumes.
class FluxesOfSolids {
 public:
  explicit FluxesOfSolids(const std::vector<SolidDescription>& solids);

  /// `flux` passes the volume's face upwards, out of its lower and into its upper pressure
  /// [m^dim/s].
  template <int dim>
  void add(int solid, const ControlVolume<dim>& volume, double flux) {
    for (int side = 0; side < 2; ++side) {
      if (volume.sides[side].unknown != no_index && flux != 0)
        fluxes_[place_[solid]].into.emplace_back(volume.sides[side].unknown,
                                                 side == 0 ? -flux : flux);
    }
  }
  /// Adds what a solid pushes into unknowns.
  void add(int solid, const std::vector<std::pair<GlobalIndex, double>>& into) {
    std::vector<std::pair<GlobalIndex, double>>& all = fluxes_[place_[solid]].into;
    all.insert(all.end(), into.begin(), into.end());
  }
  std::vector<PrescribedFlux> take() { return std::move(fluxes_); }

 private:
  std::vector<int> place_;  ///< by solid; -1: not prescribed
  std::vector<PrescribedFlux> fluxes_;
};

}  // namespace lockstep
