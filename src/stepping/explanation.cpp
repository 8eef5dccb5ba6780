// Explanation of a run, for --explain.
#include "base/memory.hpp"
#include "stepping/simulation.hpp"

namespace lockstep {

template <int dim>
std::string Simulation<dim>::explain() {
  const auto& fluid = *components_.fluid;
  const auto& solids = *components_.solids;
  const PeakMemory memory = peak_memory_mb(comm_);
  std::string text;
  const auto line = [&text](const std::string& what, const std::string& value) {
    text += fmt::format("{:<22} {}\n", what, value);
  };
  line("dimension", std::to_string(dim));
  line("ranks", std::to_string(comm_->getSize()));
  line("fluid", fmt::format("{}, h = {:g} m, {} pressure unknowns", fluid.name(),
                            fluid.smallest_length(), fluid.pressure_map()->getGlobalNumElements()));
  const bool reads_pressure = scene_options_.step.prediction.incremental_pressure;
  const auto* viscous = components_.fluid->viscosity();
  line("viscous solve", !viscous ? "off (inviscid)"
                        : viscous->wants_present_pressure()
                            ? "on (surface tension is semi-implicit), after one more "
                              "pressure solve"
                        : reads_pressure ? "on (viscosity > 0), reads the last pressure"
                                         : "on (viscosity > 0), without pressure");
  int n_prescribed = 0, n_shells = 0;
  for (const auto& solid : solids.solids()) {
    n_prescribed += solid.prescribed ? 1 : 0;
    n_shells += solid.closed ? 0 : 1;
  }
  if (const auto* output = fluid.output()) {
    for (const auto& [title, note] : output->notes())
      line(title, note);
  }
  line("solids", fmt::format("{} ({} prescribed, {} thin shells), {} unknowns",
                             solids.solids().size(), n_prescribed, n_shells, solids.n_unknowns()));
  const GlobalIndex n_coupled =
      sum_all(comm_, static_cast<GlobalIndex>(fluid.coupled_volumes().size()));
  line("coupling", fmt::format("{}, {} mixed faces", components_.coupling->name(), n_coupled));
  line("S1, S2", solids.has_unknowns()
                     ? "coupled solves of Eq. 16 by " + components_.strategy->name()
                     : "no dynamic solids: one Poisson CG per step, no S1");
  line("F2", solids.empty() ? "not needed: no solids"
                            : "Poisson solve with the solids' effective velocity");
  if (const ConstraintModel* joints = components_.solids->joints())
    line("joints", joints->note());
  line("contact", components_.contact ? components_.contact->name() : "none");
  line("pressure regions", fmt::format("{}, null space of dimension {}", fluid.regions().n_regions,
                                       scheme_->system().null_space().size()));
  line("memory so far",
       fmt::format(
           "{:.0f} MB over all ranks, {:.0f} bytes a cell", memory.all_ranks_mb,
           1e6 * memory.all_ranks_mb / double(fluid.pressure_map()->getGlobalNumElements())));
  return text;
}

template std::string Simulation<2>::explain();
template std::string Simulation<3>::explain();

}  // namespace lockstep
