// The part of VolumeLedger that shifts phi.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "liquid/common/volume_ledger.hpp"

namespace lockstep {

namespace {
/// Layers of dry cells beside the liquid that are shifted with it.
constexpr int shifted_layers = 3;
/// Total volume defect, as a part of the components' targets, above which other components take it
/// over [1].
constexpr double negligible_defect = 1e-6;

/// Shifts that would give components with these volumes their targets [m], were nothing in the way.
std::vector<double> wanted_shifts(VolumeCorrection correction, const std::vector<double>& targets,
                                  const GroupVolumes& now) {
  std::vector<double> shift(targets.size(), 0.0);
  const auto ratio = [](double missing, double area) { return area > 0 ? missing / area : 0; };
  if (correction == VolumeCorrection::component)
    for (std::size_t group = 0; group < targets.size(); ++group)
      shift[group] = ratio(targets[group] - now.volume[group], now.area[group]);
  if (correction == VolumeCorrection::global) {
    const double target = std::accumulate(targets.begin(), targets.end(), 0.0);
    const double volume = std::accumulate(now.volume.begin(), now.volume.end(), 0.0);
    const double area = std::accumulate(now.area.begin(), now.area.end(), 0.0);
    shift.assign(targets.size(), ratio(target - volume, area));
  }
  return shift;
}
}  // namespace

void declare_volume_correction(ParameterList& list) {
  declare_choice(list, "Volume Correction", "component", {"component", "global", "none"},
                 "Shifts the surface so that no volume is gained or lost. component: each liquid "
                 "component keeps its own, and nothing goes through a shell; global: all together; "
                 "none: volume is measured only.");
}

VolumeParameters read_volume_correction(const ParameterList& list) {
  VolumeParameters parameters;
  const auto correction = list.get<std::string>("Volume Correction");
  parameters.correction = correction == "component" ? VolumeCorrection::component
                          : correction == "global"  ? VolumeCorrection::global
                                                    : VolumeCorrection::none;
  return parameters;
}

/// Bodies of a few cells cannot be shifted by what they lack; until they can, others of the same
/// closed space have it.
template <int dim>
std::vector<double> VolumeLedger<dim>::limited_shifts(const SolidCells<dim>& solids,
                                                      const std::vector<double>& left) const {
  std::vector<double> shift = wanted_shifts(parameters_.correction, targets_.of_group, volumes_);
  double total_defect = 0, target = 0;
  std::vector<double> defect(groups_.n);
  for (int body = 0; body < groups_.n; ++body) {
    const double missing = targets_.of_group[body] - volumes_.volume[body];
    shift[body] = std::clamp(shift[body], -left[body], left[body]);
    defect[body] = missing - shift[body] * volumes_.area[body];
    total_defect += std::abs(defect[body]);
    target += targets_.of_group[body];
  }
  if (parameters_.correction != VolumeCorrection::component ||
      !(total_defect > negligible_defect * std::abs(target)))
    return shift;
  const CellGroups& spaces = find_closed_spaces(domain_, solids);
  const std::vector<int> space = places_among(domain_, spaces, groups_);
  std::vector<double> defect_in(spaces.n, 0.0), area_in(spaces.n, 0.0);
  const auto stands_in = [&](int body) { return std::abs(shift[body]) < left[body]; };
  for (int body = 0; body < groups_.n; ++body) {
    defect_in[space[body]] += defect[body];
    area_in[space[body]] += stands_in(body) ? volumes_.area[body] : 0;
  }
  for (int body = 0; body < groups_.n; ++body)
    if (stands_in(body) && area_in[space[body]] > 0)
      shift[body] = std::clamp(shift[body] + defect_in[space[body]] / area_in[space[body]],
                               -left[body], left[body]);
  return shift;
}

template <int dim>
VolumeShift VolumeLedger<dim>::correct(const SolidCells<dim>& solids, double cfl, double cut_off,
                                       const std::function<void()>& settle, CellField& phi) {
  if (parameters_.correction == VolumeCorrection::none || groups_.n == 0)
    return {};
  const double most = parameters_.largest_shift * domain_.spacing() * std::max(1.0, cfl);
  VolumeShift done;
  CellGroups shifted;  // components that the cells on and beside them belong to
  std::vector<double> left(groups_.n, most);
  bool has_regrouped = true;
  // A second time for what is not linear in the shift.
  for (int pass = 0; pass < 2; ++pass) {
    std::vector<double> shift = limited_shifts(solids, left);
    bool any = false;
    for (int body = 0; body < groups_.n; ++body) {
      // Round-off of the measure is not to move what is at rest: that of one cell, and of the sum.
      constexpr double round_off = 1e-13;
      if (std::abs(shift[body]) * volumes_.area[body] <
          round_off * (domain_.spacing() * volumes_.area[body] + volumes_.volume[body]))
        shift[body] = 0;
      left[body] -= std::abs(shift[body]);
      targets_.shift += std::abs(shift[body]) * volumes_.area[body];
      any = any || shift[body] != 0;
    }
    if (!any)
      break;
    if (has_regrouped) {
      shifted = groups_;
      spread_labels(domain_, solids, phi, shifted_layers, shifted.of_cell);
    }
    done.resize(phi.size(), 0);
    double n_changed = 0;
    domain_.grid.for_each_owned_cell([&](int cell) {
      const int body = shifted.of_cell[cell];
      // cells far from the surface stay far: shifted, all deep water would be near it
      if (body < 0 || !solids.is_fluid(cell) || std::abs(phi[cell]) >= cut_off)
        return;
      const bool was_wet = phi[cell] < 0;
      phi[cell] = std::clamp(phi[cell] - shift[body], -cut_off, cut_off);
      done[cell] += shift[body];
      n_changed += was_wet != (phi[cell] < 0);
    });
    settle();
    if (most > 0.5 * domain_.spacing())
      measure_.prepare(solids, phi);
    has_regrouped = sum_all(domain_.grid.comm(), n_changed) > 0;
    if (has_regrouped) {
      regroup(solids, solids, phi, {}, 1);
      const std::vector<double> left_before = left;
      left.clear();
      for (const int before : places_among(domain_, shifted, groups_))
        left.push_back(left_before[before]);
    } else {
      volumes_ = measure_.measure(phi, groups_);
    }
  }
  return done;
}

template std::vector<double> VolumeLedger<2>::limited_shifts(const SolidCells<2>&,
                                                             const std::vector<double>&) const;
template std::vector<double> VolumeLedger<3>::limited_shifts(const SolidCells<3>&,
                                                             const std::vector<double>&) const;
template VolumeShift VolumeLedger<2>::correct(const SolidCells<2>&, double, double,
                                              const std::function<void()>&, CellField&);
template VolumeShift VolumeLedger<3>::correct(const SolidCells<3>&, double, double,
                                              const std::function<void()>&, CellField&);

}  // namespace lockstep
