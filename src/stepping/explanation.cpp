#include "stepping/explanation.hpp"

#include <fmt/format.h>

#include "base/memory.hpp"
#include "interfaces/fluid_sides.hpp"
#include "interfaces/viscosity.hpp"
#include "stepping/solid_rows.hpp"

namespace lockstep {

template <int dim>
std::string explanation(Components<dim>& components, TimeScheme<dim>& scheme,
                        const SceneOptions& options) {
  const bool reads_pressure = options.step.prediction.incremental_pressure;
  const auto& fluid = *components.fluid;
  const auto& solids = *components.solids;
  const Communicator& comm = solids.comm();
  const PeakMemory memory = peak_memory_mb(comm);
  std::string text;
  const auto line = [&text](const std::string& what, const std::string& value) {
    text += fmt::format("{:<22} {}\n", what, value);
  };
  line("dimension", std::to_string(dim));
  line("ranks", std::to_string(comm->getSize()));
  line("fluid", fmt::format("{}, h = {:g} m, {} pressure unknowns", fluid.name(),
                            fluid.smallest_length(), fluid.pressure_map()->getGlobalNumElements()));
  const auto* viscous = components.fluid->viscosity();
  line("viscous solve", !viscous ? "off (inviscid)"
                        : viscous->wants_present_pressure()
                            ? "on (surface tension is semi-implicit), after one more "
                              "pressure solve"
                        : reads_pressure ? "on (viscosity > 0), reads the last pressure"
                                         : "on (viscosity > 0), without pressure");
  int n_prescribed = 0, n_shells = 0, n_lines = 0;
  for (const auto& solid : solids.solids()) {
    const bool has_surface = !is_line(solid);
    n_lines += has_surface ? 0 : 1;
    n_prescribed += solid.prescribed && has_surface ? 1 : 0;
    n_shells += !solid.closed && has_surface ? 1 : 0;
  }
  if (const auto* output = fluid.output()) {
    for (const auto& [title, note] : output->notes())
      line(title, note);
  }
  line("solids",
       fmt::format("{} ({} prescribed, {} thin shells){}, {} unknowns",
                   solids.solids().size() - n_lines, n_prescribed, n_shells,
                   n_lines == 0 ? "" : fmt::format(" and {} lines", n_lines), solids.n_unknowns()));
  text += solid_rows(components, *scheme.system().surface());
  const GlobalIndex n_coupled =
      sum_all(comm, static_cast<GlobalIndex>(fluid.coupled_volumes().size()));
  const std::string& why = components.coupling_note;
  line("coupling", fmt::format("{}{}, {} mixed faces", components.coupling->name(),
                               why.empty() ? "" : fmt::format(" (automatic: {})", why), n_coupled));
  line("S1, S2", solids.has_unknowns()
                     ? "coupled solves of Eq. 16 by " + components.strategy->name()
                     : "no dynamic solids: one Poisson CG per step, no S1");
  line("F2", solids.empty() ? "not needed: no solids"
                            : "Poisson solve with the solids' effective velocity");
  if (const ConstraintModel* joints = components.solids->joints())
    line("joints", joints->note());
  line("contact", components.contact ? components.contact->name() : "none");
  line("pressure regions", fmt::format("{}, null space of dimension {}", fluid.regions().n_regions,
                                       scheme.system().null_space().size()));
  const auto n_pressures = double(fluid.pressure_map()->getGlobalNumElements());
  line("memory so far", fmt::format("{:.0f} MB over all ranks{}", memory.all_ranks_mb,
                                    n_pressures == 0  // an empty tank that sources are to fill
                                        ? ""
                                        : fmt::format(", {:.0f} bytes a cell",
                                                      1e6 * memory.all_ranks_mb / n_pressures)));
  text += solid_warnings(components, *scheme.system().surface());
  return text;
}

template std::string explanation(Components<2>&, TimeScheme<2>&, const SceneOptions&);
template std::string explanation(Components<3>&, TimeScheme<3>&, const SceneOptions&);

}  // namespace lockstep
