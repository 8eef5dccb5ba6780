#include "mixedface/solid_fluxes.hpp"

#include <fmt/format.h>

#include "coupling/solid_system.hpp"
#include "mixedface/mixed_face_coupling.hpp"

namespace lockstep {

FluxesOfSolids::FluxesOfSolids(const std::vector<SolidDescription>& solids) {
  for (const SolidDescription& solid : solids) {
    place_.push_back(solid.prescribed ? static_cast<int>(fluxes_.size()) : -1);
    if (solid.prescribed)
      fluxes_.push_back({fmt::format("the solid \"{}\"", solid.name), {}});
  }
}

template <int dim>
std::vector<PrescribedFlux> MixedFaceCoupling<dim>::solid_fluxes(
    const SolidSystem<dim>& solids) const {
  FluxesOfSolids fluxes(solids.solids());
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    for (const SurfaceShare<dim>& share : shares_[f]) {
      if (!solids.solids()[share.solid].prescribed)
        continue;
      const Point<dim> v = solids.prescribed_velocity(share.point, volume.center);
      fluxes.add(share.solid, volume, share.weight * volume.area * v[volume.direction]);
    }
  }
  return fluxes.take();
}

template std::vector<PrescribedFlux> MixedFaceCoupling<2>::solid_fluxes(
    const SolidSystem<2>&) const;
template std::vector<PrescribedFlux> MixedFaceCoupling<3>::solid_fluxes(
    const SolidSystem<3>&) const;

}  // namespace lockstep
