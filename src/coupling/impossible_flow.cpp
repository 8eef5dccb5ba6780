#include "coupling/impossible_flow.hpp"

#include <fmt/format.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/communicator.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

namespace {

constexpr double least_one_way = 0.5, side_round_off = 1e-6, solid_inaccuracy = 0.1;

/// Rate at which a source changes the volume of a region, and the sum of the magnitudes of its
/// faces' rates [m^dim/s].
struct Rate {
  const PrescribedFlux* source;
  double net = 0, gross = 0;

  template <typename F>
  void for_each_part(const F& f) {
    f(net);
    f(gross);
  }
};

/// The region of each unknown that the sources push into (`import`), and the values of the null
/// vectors there, scaled to 1 at most.
struct Weights {
  std::vector<int> region;
  RCP<const Map> unknowns;
  std::vector<std::vector<double>> of_region;  ///< [null vector][region]; in none: at the end, 0

  double operator()(std::size_t k, GlobalIndex unknown) const {
    return of_region[k][region[unknowns->getLocalElement(unknown)]];
  }
};

Weights weights_of(const NullSpace& space, const Import& import) {
  const RowRegions& regions = space.regions();
  Weights weights;
  weights.unknowns = import.getTargetMap();
  Vector numbers(weights.unknowns);
  numbers.doImport(*regions.numbers(), import, Tpetra::INSERT);
  for (const double number : numbers.getData())
    weights.region.push_back(number < 0 ? regions.n_regions : static_cast<int>(number));
  for (const auto& parts : space.vectors()) {
    std::vector<double> values(regions.n_regions + 1, 0);
    double largest = 0;
    for (const NullSpace::Part& part : parts)
      largest = std::max(largest, std::abs(part.value));
    for (const NullSpace::Part& part : parts)
      values[part.region] = part.value / largest;
    weights.of_region.push_back(std::move(values));
  }
  return weights;
}

/// Returns for each null vector the rates of all sources. One sum over ranks.
std::vector<std::vector<Rate>> rates_of(const std::vector<PrescribedFlux>& sources,
                                        const Weights& weights, const Communicator& comm) {
  std::vector<std::vector<Rate>> rates(weights.of_region.size());
  for (std::size_t k = 0; k < rates.size(); ++k) {
    for (const PrescribedFlux& source : sources) {
      double net = 0, gross = 0;
      for (const auto& [unknown, rate] : source.into) {
        const double part = rate * weights(k, unknown);
        net += part;
        gross += std::abs(part);
      }
      rates[k].push_back({&source, net, gross});
    }
  }
  sum_over_ranks(comm, rates);
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

/// The cells in which a null vector counts.
GlobalIndex n_cells_of(const std::vector<double>& weights, const std::vector<double>& n_rows) {
  double n = 0;
  for (std::size_t region = 0; region < n_rows.size(); ++region)
    n += std::abs(weights[region]) > 1e-3 ? n_rows[region] : 0;
  return static_cast<GlobalIndex>(n);
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

std::string impossible_flow(const NullSpace& null_space, const PrescribedFluxes& fluxes,
                            GlobalIndex smallest_region, double negligible,
                            const std::string& unit) {
  if (null_space.empty() || (fluxes.sides.empty() && fluxes.solids.empty()))
    return "";
  const RCP<const Map> map = null_space.regions().map;
  const Communicator comm = map->getComm();
  const Weights weights = weights_of(null_space, *import_of_unknowns(fluxes, map));
  const auto by_sides = rates_of(fluxes.sides, weights, comm);
  const auto by_solids = rates_of(fluxes.solids, weights, comm);
  const std::vector<double> n_rows = null_space.regions().n_rows();
  for (std::size_t k = 0; k < null_space.size(); ++k) {
    const Verdict verdict = verdict_on(by_sides[k], by_solids[k]);
    const GlobalIndex n_cells = n_cells_of(weights.of_region[k], n_rows);
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

namespace {

template <int dim>
bool is_soft(const SolidModel<dim>& model) {
  const std::vector<SolidDescription>& solids = model.solids();
  return std::any_of(solids.begin(), solids.end(),
                     [](const SolidDescription& solid) { return solid.is_soft_body(); });
}

/// True if a soft body could be pushed out through a side of the domain.
template <int dim>
bool reaches_out(const SurfaceSnapshot<dim>& surface, const Box<dim>& domain, double cell) {
  const Point<dim> margin = Point<dim>::Constant(cell);
  const Box<dim> around(domain.min() - margin, domain.max() + margin);
  for (std::size_t s = 0; s < surface.solids().size(); ++s) {
    if (surface.solids()[s].is_soft_body() &&
        !around.contains(surface.own_bounds(static_cast<int>(s))))
      return true;
  }
  return false;
}

/// B^T x, the push of pressures on the solids.
RCP<Vector> push_of(const Vector& pressures, const CrsMatrix& coupling_transposed) {
  const RCP<Vector> push = make_vector(coupling_transposed.getRowMap());
  coupling_transposed.apply(pressures, *push);
  return push;
}

}  // namespace

template <int dim>
NullSpace fluid_that_squeezes_solids(const NullSpace& pressure,
                                     const CrsMatrix& coupling_transposed,
                                     const SolidSystem<dim>& solids,
                                     const SurfaceSnapshot<dim>& surface, const Box<dim>& domain,
                                     double cell) {
  const std::vector<double> n_rows = pressure.regions().n_rows();
  double n = 0;
  for (const double of_region : n_rows)
    n += of_region;
  std::vector<NullSpace::Part> all;
  for (std::size_t region = 0; region < n_rows.size(); ++region)
    all.push_back({static_cast<int>(region), 1 / std::sqrt(n)});
  NullSpace closed = pressure.with({std::move(all)});

  const RCP<Vector> pressures = closed.vector(0);
  const RCP<Vector> of_closed = push_of(*pressures, coupling_transposed);
  const RCP<Vector> open = make_vector(pressures->getMap());
  open->putScalar(1 / std::sqrt(n));
  open->update(-1, *pressures, 1);
  const RCP<Vector> of_open = push_of(*open, coupling_transposed);
  const double round_off = round_off_of_sums(coupling_transposed);
  bool has_soft_body = false;
  for (int m = 0; m < solids.n_models(); ++m) {
    const bool soft = is_soft(solids.model(m));
    has_soft_body = has_soft_body || soft;
    if (solids.part(soft ? *of_open : *of_closed, m)->normInf() > round_off)
      return pressure.with({});
  }
  return has_soft_body && !reaches_out(surface, domain, cell) ? closed : pressure.with({});
}

template NullSpace fluid_that_squeezes_solids(const NullSpace&, const CrsMatrix&,
                                              const SolidSystem<2>&, const SurfaceSnapshot<2>&,
                                              const Box<2>&, double);
template NullSpace fluid_that_squeezes_solids(const NullSpace&, const CrsMatrix&,
                                              const SolidSystem<3>&, const SurfaceSnapshot<3>&,
                                              const Box<3>&, double);

}  // namespace lockstep
