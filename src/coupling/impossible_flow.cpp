#include "coupling/impossible_flow.hpp"

#include <fmt/format.h>

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/communicator.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

namespace {

constexpr double least_one_way = 0.5, side_round_off = 1e-6, solid_inaccuracy = 0.1;

/// What a source changes a region's volume by, and all that its faces push, either way [m^dim/s].
struct Rate {
  const PrescribedFlux* source;
  double net = 0, gross = 0;
};

/// The weight of every face's unknown in a null vector, whose largest is 1, source by source.
std::vector<Rate> rates_of(const std::vector<PrescribedFlux>& sources, const Vector& weights,
                           const Communicator& comm) {
  std::vector<double> sums;
  const auto weight = weights.getData();
  for (const PrescribedFlux& source : sources) {
    double net = 0, gross = 0;
    for (const auto& [unknown, rate] : source.into) {
      const double part = rate * weight[weights.getMap()->getLocalElement(unknown)];
      net += part;
      gross += std::abs(part);
    }
    sums.push_back(net);
    sums.push_back(gross);
  }
  sum_all(comm, sums.data(), static_cast<int>(sums.size()));
  std::vector<Rate> rates;
  for (std::size_t s = 0; s < sources.size(); ++s)
    rates.push_back({&sources[s], sums[2 * s], sums[2 * s + 1]});
  return rates;
}

RCP<Import> import_of_unknowns(const PrescribedFluxes& fluxes, const RCP<const Map>& map) {
  std::vector<GlobalIndex> unknowns;
  for (const auto* sources : {&fluxes.sides, &fluxes.solids}) {
    for (const PrescribedFlux& source : *sources) {
      for (const auto& entry : source.into)
        unknowns.push_back(entry.first);
    }
  }
  return import_of(std::move(unknowns), map);
}

GlobalIndex n_cells_of(const Vector& indicator, double largest) {
  GlobalIndex n = 0;
  for (const double value : indicator.getData())
    n += std::abs(value) > 1e-3 * largest;
  return sum_all(indicator.getMap()->getComm(), n);
}

/// The sources that change the volume; their sum is `change`, known to `inaccuracy`.
struct Verdict {
  std::vector<Rate> guilty;
  double change = 0, inaccuracy = 0;
};

Verdict verdict_on(const std::vector<Rate>& sides, const std::vector<Rate>& solids) {
  Verdict verdict;
  const auto add = [&verdict](const Rate& rate, double inaccuracy) {
    verdict.guilty.push_back(rate);
    verdict.change += rate.net;
    verdict.inaccuracy += inaccuracy;
  };
  for (const Rate& rate : sides) {
    if (rate.gross > 0)
      add(rate, side_round_off * rate.gross);
  }
  for (const Rate& rate : solids) {
    if (std::abs(rate.net) > least_one_way * rate.gross)
      add(rate, solid_inaccuracy * std::abs(rate.net));
  }
  return verdict;
}

}  // namespace

std::string impossible_flow(const std::vector<RCP<const Vector>>& null_space,
                            const PrescribedFluxes& fluxes, const RCP<const Map>& pressure_map,
                            GlobalIndex smallest_region, double negligible,
                            const std::string& unit) {
  if (null_space.empty() || (fluxes.sides.empty() && fluxes.solids.empty()))
    return "";
  const Communicator comm = pressure_map->getComm();
  const RCP<Import> import = import_of_unknowns(fluxes, pressure_map);
  for (const auto& null_vector : null_space) {
    const double largest = null_vector->normInf();
    Vector weights(import->getTargetMap());
    weights.doImport(*null_vector, *import, Tpetra::INSERT);
    weights.scale(1 / largest);
    const Verdict verdict =
        verdict_on(rates_of(fluxes.sides, weights, comm), rates_of(fluxes.solids, weights, comm));
    const GlobalIndex n_cells = n_cells_of(*null_vector, largest);
    if (std::abs(verdict.change) <= std::max(verdict.inaccuracy, negligible) ||
        n_cells <= smallest_region)
      continue;
    std::vector<std::string> names;
    for (const Rate& rate : verdict.guilty)
      names.push_back(fmt::format("{} {} {:.4g} {}", rate.source->name,
                                  rate.net > 0 ? "pushes in" : "takes out", std::abs(rate.net),
                                  unit));
    return fmt::format(
        "{} cells of fluid are closed in, but {}: their volume would have to change by {:.4g} {}. "
        "Open a side of the domain, or let the same volume in and out.",
        n_cells, fmt::join(names, ", "), -verdict.change, unit);
  }
  return "";
}

}  // namespace lockstep
