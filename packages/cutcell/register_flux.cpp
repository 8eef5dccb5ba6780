#include "cutcell/register_flux.hpp"

#include "cutcell/flux_coupling.hpp"

namespace lockstep {
namespace {

ParameterList valid_parameters() {
  ParameterList list;
  declare_between(list, "Smallest Open Fraction", FluxOptions().smallest_open_fraction, 1e-6, 0.5,
                  "Aperture [1] below which faces are closed; the flux that they would have let "
                  "through is given to the solid in both neighbours.");
  declare_choice(list, "Weights", "face fractions", {"face fractions", "volume fractions"},
                 "Measure of a face's closed part: its own area inside the solids (Ng, Min and "
                 "Gibou 2009) or the volume of its dual cell inside them (Batty et al. 2007).");
  declare(list, "Correct Buoyancy", true,
          "Give closed bodies the exact hydrostatic force of their polyhedra in place of what the "
          "grid makes of it, so that they rest at their draft.");
  return list;
}

FluxOptions options_from(const ParameterList& list) {
  FluxOptions options;
  options.smallest_open_fraction = list.get<double>("Smallest Open Fraction");
  options.weights = list.get<std::string>("Weights") == "volume fractions" ? FaceWeights::volumes
                                                                           : FaceWeights::areas;
  options.correct_buoyancy = list.get<bool>("Correct Buoyancy");
  return options;
}

}  // namespace

template <int dim>
void register_flux(Registry<Coupling<dim>>& couplings) {
  couplings.add("flux",
                "Second-order coupling of closed bodies by the flux through cut cells: faces keep "
                "their open part; shells and thin parts move whole faces, as with 'mixed face'.",
                valid_parameters, [](const ParameterList& list) {
                  return std::make_unique<FluxCoupling<dim>>(options_from(list));
                });
}

template void register_flux<2>(Registry<Coupling<2>>&);
template void register_flux<3>(Registry<Coupling<3>>&);

}  // namespace lockstep
