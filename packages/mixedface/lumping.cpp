#include "mixedface/lumping.hpp"

#include <algorithm>

#include "faces/wet_volume.hpp"
#include "geometry/solid_volume.hpp"

namespace lockstep {

template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell,
                                 const LiquidFluid<dim>* liquid) {
  std::vector<double> masses(volumes.size(), 0);
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (volumes[f].only_gas())
      continue;
    const auto outside_of_solids = [&] {
      const double solid = whole_cell ? 0 : solid_volume_in_box<dim>(surface, volumes[f].box);
      return std::max(0., volumes[f].box.volume() - solid);
    };
    const double fluid =
        liquid ? std::max(0., wet_volume<dim>(volumes[f], surface, whole_cell, *liquid))
               : outside_of_solids();
    masses[f] = volumes[f].density * fluid;
    if (liquid && liquid->gas_density() > 0)
      masses[f] += liquid->gas_density() * std::max(0., outside_of_solids() - fluid);
  }
  return masses;
}

template std::vector<double> fluid_masses<2>(const std::vector<ControlVolume<2>>&,
                                             const SurfaceSnapshot<2>&, bool,
                                             const LiquidFluid<2>*);
template std::vector<double> fluid_masses<3>(const std::vector<ControlVolume<3>>&,
                                             const SurfaceSnapshot<3>&, bool,
                                             const LiquidFluid<3>*);

}  // namespace lockstep
