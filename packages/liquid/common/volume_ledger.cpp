#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "liquid/common/volume_ledger.hpp"

namespace lockstep {

namespace {
/// Distance in which a liquid component that vanishes looks for one to give its volume to [cells].
constexpr int giving_reach = 3;

template <int dim>
std::vector<char> wet_cells(const CellField& phi) {
  std::vector<char> wet(phi.size());
  for (std::size_t cell = 0; cell < phi.size(); ++cell)
    wet[cell] = phi[cell] < 0;
  return wet;
}

/// Calls f(cell) for the owned cells beside a side of the domain.
template <int dim, typename Function>
void for_each_cell_at_side(const TiledGrid<dim>& grid, int axis, int end, const Function& f) {
  const int last = end == 0 ? 0 : grid.n_cells()[axis] - 1;
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    const int begin = grid.tile_begin(tile)[axis];
    if (last < begin || last >= begin + tile_width<dim>)
      continue;
    for (int cell = tile * tile_volume<dim>; cell < (tile + 1) * tile_volume<dim>; ++cell)
      if (grid.in_domain(cell) && grid.coordinates(cell)[axis] == last)
        f(cell);
  }
}

/// Number of cells, over all ranks, in which each pair (new group, old group) occurs.
using Overlaps = std::map<std::pair<int, int>, double>;

Overlaps gather(const Communicator& comm, const Overlaps& mine) {
  std::vector<double> packed;
  for (const auto& [pair, n] : mine)
    packed.insert(packed.end(),
                  {static_cast<double>(pair.first), static_cast<double>(pair.second), n});
  packed = gather_all(comm, packed);
  Overlaps all;
  for (std::size_t i = 0; i < packed.size(); i += 3)
    all[{static_cast<int>(packed[i]), static_cast<int>(packed[i + 1])}] += packed[i + 2];
  return all;
}

/// The body that a cell or, of those beside it, the one nearest to the surface belongs to, -1:
/// none. A cell whose centre a solid holds has its fluid from those beside it.
template <int dim>
int body_at(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
            const std::vector<int>& of_cell, const CellField& phi, int cell) {
  int body = of_cell[cell];
  if (body >= 0)
    return body;
  double nearest = 0;
  for (int i = 0; i < 2 * dim; ++i) {
    const int other = solids.is_fluid(cell) ? solids.seen_neighbor(grid, cell, i / 2, i % 2)
                                            : grid.neighbor(cell, i / 2, i % 2);
    if (other < 0 || of_cell[other] < 0)
      continue;
    const double distance = std::abs(phi[other]);
    if (body < 0 || distance < nearest || (distance == nearest && of_cell[other] < body)) {
      body = of_cell[other];
      nearest = distance;
    }
  }
  return body;
}

/// Returns the places of vanished components, of all that `places` has by cell; for those that
/// surfaces passed over, the components around.
template <int dim>
std::vector<int> places_of(const MacDomain<dim>& domain, std::vector<int> places,
                           const std::vector<char>& vanished, const SolidCells<dim>& before,
                           const CellField& phi, const std::vector<char>& swept) {
  for (int& group : places)
    if (group >= 0 && !vanished[group])
      group = -1;
  double n_swept = 0;
  for (std::size_t cell = 0; cell < swept.size(); ++cell)
    n_swept += swept[cell] && places[cell] >= 0;
  if (sum_all(domain.grid.comm(), n_swept) == 0)
    return places;
  spread_labels(domain, before, phi, giving_reach, places);
  for (std::size_t cell = 0; cell < swept.size(); ++cell)
    if (swept[cell])
      places[cell] = -1;
  return places;
}
}  // namespace

template <int dim>
std::vector<int> places_among(const MacDomain<dim>& domain, const CellGroups& spaces,
                              const CellGroups& bodies) {
  if (spaces.n == 1)
    return std::vector<int>(bodies.n, 0);
  Overlaps mine;
  std::pair<int, int> last{-1, -1};
  domain.grid.for_each_owned_cell([&](int cell) {
    const std::pair<int, int> pair{bodies.of_cell[cell], spaces.of_cell[cell]};
    if (pair.first >= 0 && pair != last)
      mine[last = pair] = 1;
  });
  std::vector<int> space(bodies.n, 0);
  for (const auto& [pair, n] : gather(domain.grid.comm(), mine))
    space[pair.first] = pair.second;
  return space;
}

template <int dim>
VolumeLedger<dim>::VolumeLedger(const MacDomain<dim>& domain, const VolumeParameters& parameters)
    : domain_(domain), parameters_(parameters), measure_(domain) {}

template <int dim>
CellGroups VolumeLedger<dim>::find(const SolidCells<dim>& solids, const CellField& phi) const {
  return find_groups(domain_, solids, wet_cells<dim>(phi));
}

template <int dim>
void VolumeLedger<dim>::begin(const SolidCells<dim>& solids, const CellField& phi) {
  restore(solids, phi, {});
  targets_.of_group = volumes_.volume;
  targets_.loose = volumes_.loose;
}

template <int dim>
void VolumeLedger<dim>::restore(const SolidCells<dim>& solids, const CellField& phi,
                                const VolumeTargets& targets) {
  groups_ = find(solids, phi);
  measure_.prepare(solids, phi);
  volumes_ = measure_.measure(phi, groups_);
  targets_ = targets;
}

template <int dim>
void VolumeLedger<dim>::flow_out(const SolidCells<dim>& solids, const CellField& phi,
                                 const InterfaceStep<dim>& step) {
  const TiledGrid<dim>& grid = domain_.grid;
  const double per_speed = step.dt * domain_.face_area(), h = domain_.spacing();
  std::vector<double> out(groups_.n, 0.0);
  is_open_.assign(groups_.n, 0);
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      const SideType type = domain_.boundary.side(axis, end).type;
      if (type != SideType::open && type != SideType::inflow)
        continue;
      for_each_cell_at_side(grid, axis, end, [&](int cell) {
        // cells count whose centre is above the surface, too: else the flux jumps as it passes
        const double wet = std::clamp(0.5 - phi[cell] / h, 0.0, 1.0);
        const int face = end == 0 ? cell : grid.neighbor(cell, axis, 1);
        const double open = wet > 0 ? step.open_part(axis, face) : 0;
        const int body = open > 0 ? body_at(grid, solids, groups_.of_cell, phi, cell) : -1;
        if (body < 0)
          return;
        const double flux =
            (end == 0 ? -1 : 1) * step.advection_velocity[axis][face] * per_speed * open;
        if (type == SideType::open && flux > 0 && wet < 1)
          is_open_[body] = 1;
        if (type == SideType::inflow || flux > 0)
          out[body] += flux * wet;
      });
    }
  sum_over_ranks(grid.comm(), out, is_open_);
  for (int group = 0; group < groups_.n; ++group) {
    // a long step may let out more than a small component has
    double& target = targets_.of_group[group];
    target -= std::min(out[group], std::max(target, 0.0));
  }
}

template <int dim>
void VolumeLedger<dim>::inherit(const SolidCells<dim>& before, const SolidCells<dim>& solids,
                                const CellField& phi, const std::vector<char>& swept, int reach) {
  measure_.prepare(solids, phi);
  regroup(before, solids, phi, swept, reach);
  for (int group = 0; group < groups_.n && !is_open_.empty(); ++group)
    if (is_open_[group] > 0)
      targets_.of_group[group] = volumes_.volume[group];
  is_open_.clear();
}

template <int dim>
void VolumeLedger<dim>::share_unassigned(const SolidCells<dim>& solids, double unassigned) {
  const double there = std::accumulate(volumes_.volume.begin(), volumes_.volume.end(), 0.0);
  if (solids.has_shells() || there <= 0) {
    // It must not come out beyond a shell, or there is nobody to take it.
    const double gone = std::max(targets_.loose - volumes_.loose, 0.0);
    targets_.loose -= gone;
    targets_.lost += gone + unassigned;
  } else {
    const double given = unassigned + targets_.loose - volumes_.loose;
    for (int group = 0; group < groups_.n && given != 0; ++group)
      targets_.of_group[group] += given * volumes_.volume[group] / there;
    targets_.loose = volumes_.loose;
  }
}

template <int dim>
void VolumeLedger<dim>::regroup(const SolidCells<dim>& before, const SolidCells<dim>& solids,
                                const CellField& phi, const std::vector<char>& swept, int reach) {
  const TiledGrid<dim>& grid = domain_.grid;
  CellGroups groups = find(solids, phi);
  std::vector<int> ancestor = groups_.of_cell;
  for (std::size_t cell = 0; cell < swept.size(); ++cell)
    if (swept[cell])
      ancestor[cell] = -1;
  const auto overlaps_of = [&](const auto& counts) {
    Overlaps mine;
    std::pair<int, int> last{-1, -1};
    double n = 0;
    grid.for_each_owned_cell([&](int cell) {
      const std::pair<int, int> pair{groups.of_cell[cell], ancestor[cell]};
      if (pair.first < 0 || pair.second < 0 || !counts(pair.first))
        return;
      if (pair != last && n > 0) {
        mine[last] += n;
        n = 0;
      }
      last = pair;
      ++n;
    });
    if (n > 0)
      mine[last] += n;
    return gather(grid.comm(), mine);
  };
  Overlaps overlaps = overlaps_of([](int) { return true; });
  std::vector<char> has_ancestor(groups.n, 0), vanished(groups_.n, 1);
  for (const auto& [pair, n] : overlaps)
    has_ancestor[pair.first] = 1;
  if (std::count(has_ancestor.begin(), has_ancestor.end(), 0) > 0) {
    // A component that moves by more than its size comes from the nearest one before.
    domain_.halo.fill(ancestor);
    spread_labels(domain_, solids, phi, reach, ancestor);
    overlaps.merge(overlaps_of([&](int group) { return !has_ancestor[group]; }));
  }
  volumes_ = measure_.measure(phi, groups);

  std::vector<double> n_cells(groups.n, 0.0), claims(groups_.n, 0.0);
  for (const auto& [pair, n] : overlaps)
    n_cells[pair.first] += n;
  const auto claim = [&](const std::pair<int, int>& pair, double n) {
    return std::max(volumes_.volume[pair.first], 1e-300) * n / n_cells[pair.first];
  };
  for (const auto& [pair, n] : overlaps) {
    claims[pair.second] += claim(pair, n);
    vanished[pair.second] = 0;
  }
  std::vector<double> target(groups.n, 0.0), is_open(is_open_.empty() ? 0 : groups.n, 0.0);
  for (const auto& [pair, n] : overlaps) {
    const double share = claim(pair, n) / claims[pair.second];
    target[pair.first] += targets_.of_group[pair.second] * share;
    if (!is_open_.empty())
      is_open[pair.first] += is_open_[pair.second];
  }
  for (std::size_t old = 0; old < is_open_.size(); ++old)
    if (is_open_[old] > 0)
      vanished[old] = 0;  // the rest of it has gone through the side
  double unassigned = 0;
  if (std::count(vanished.begin(), vanished.end(), 1) > 0)
    unassigned = give_to_nearest(solids, phi, groups,
                                 places_of(domain_, groups_.of_cell, vanished, before, phi, swept),
                                 vanished, target);
  groups_ = std::move(groups);
  targets_.of_group = std::move(target);
  is_open_ = std::move(is_open);
  share_unassigned(solids, unassigned);
}

template <int dim>
double VolumeLedger<dim>::give_to_nearest(const SolidCells<dim>& solids, const CellField& phi,
                                          const CellGroups& groups, const std::vector<int>& places,
                                          std::vector<char> unassigned,
                                          std::vector<double>& target) {
  const TiledGrid<dim>& grid = domain_.grid;
  std::vector<int> nearest = groups.of_cell;
  spread_labels(domain_, solids, phi, giving_reach, nearest);
  Overlaps mine;
  grid.for_each_owned_cell([&](int cell) {
    if (places[cell] >= 0 && nearest[cell] >= 0)
      mine[{places[cell], nearest[cell]}] += 1;
  });
  std::map<int, std::pair<double, int>> heir;  // most cells; the first of several
  for (const auto& [pair, n] : gather(grid.comm(), mine)) {
    auto& best = heir[pair.first];
    if (n > best.first)
      best = {n, pair.second};
  }
  for (const auto& [old, best] : heir) {
    target[best.second] += targets_.of_group[old];
    unassigned[old] = 0;
  }
  if (std::count(unassigned.begin(), unassigned.end(), 1) > 0)
    return share_out(solids, groups, places, unassigned, target);
  return 0;
}

template <int dim>
double VolumeLedger<dim>::share_out(const SolidCells<dim>& solids, const CellGroups& groups,
                                    const std::vector<int>& places,
                                    const std::vector<char>& unassigned,
                                    std::vector<double>& target) {
  const CellGroups& spaces = find_closed_spaces(domain_, solids);
  Overlaps of_old;
  domain_.grid.for_each_owned_cell([&](int cell) {
    const int old = places[cell];
    if (old >= 0 && unassigned[old] && solids.is_fluid(cell))
      of_old[{old, spaces.of_cell[cell]}] += 1;
  });
  const std::vector<int> space = places_among(domain_, spaces, groups);
  std::vector<double> volume_in_space(spaces.n, 0.0);
  for (int group = 0; group < groups.n; ++group)
    volume_in_space[space[group]] += volumes_.volume[group];
  std::map<int, std::pair<double, int>> space_of_old;
  for (const auto& [pair, n] : gather(domain_.grid.comm(), of_old)) {
    auto& most = space_of_old[pair.first];
    if (n > most.first)
      most = {n, pair.second};
  }
  std::vector<double> given(spaces.n, 0.0);
  double left = 0;
  for (int old = 0; old < groups_.n; ++old) {
    if (!unassigned[old])
      continue;
    const auto found = space_of_old.find(old);
    if (found != space_of_old.end() && volume_in_space[found->second.second] > 0)
      given[found->second.second] += targets_.of_group[old];
    else
      left += targets_.of_group[old];
  }
  for (int group = 0; group < groups.n; ++group)
    if (given[space[group]] != 0)
      target[group] += given[space[group]] * volumes_.volume[group] / volume_in_space[space[group]];
  return left;
}

template <int dim>
void VolumeLedger<dim>::remove(const SolidCells<dim>& solids, const CellField& phi) {
  measure_.prepare(solids, phi);
  const GroupVolumes left = measure_.measure(phi, groups_);
  for (int group = 0; group < groups_.n; ++group)
    targets_.of_group[group] += left.volume[group] - volumes_.volume[group];
  targets_.loose = std::min(targets_.loose, left.loose);
  inherit(solids, solids, phi, {}, 1);
}

template <int dim>
void VolumeLedger<dim>::create(const SolidCells<dim>& solids, const CellField& before,
                               const CellField& phi) {
  measure_.prepare(solids, before);
  const CellGroups groups = find(solids, phi);
  const GroupVolumes there = measure_.measure(before, groups);
  measure_.prepare(solids, phi);
  const GroupVolumes now = measure_.measure(phi, groups);
  targets_.loose += now.loose - there.loose;
  regroup(solids, solids, phi, {}, 1);
  for (int group = 0; group < groups_.n; ++group)
    targets_.of_group[group] += now.volume[group] - there.volume[group];
}

template <int dim>
WatchedLiquid VolumeLedger<dim>::in_cells(const CellField& phi,
                                          const std::vector<char>& cells) const {
  CellGroups there = groups_;
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    if (!cells[cell])
      there.of_cell[cell] = -1;
  const GroupVolumes volumes = measure_.measure(phi, there);
  WatchedLiquid liquid;
  for (int group = 0; group < groups_.n; ++group) {
    if (volumes.volume[group] == 0)
      continue;
    liquid.volume += volumes.volume[group];
    liquid.target += targets_.of_group[group] * volumes.volume[group] / volumes_.volume[group];
  }
  return liquid;
}

template <int dim>
LiquidLedger VolumeLedger<dim>::state() const {
  LiquidLedger ledger;
  ledger.volume = volumes_.total();
  ledger.target =
      std::accumulate(targets_.of_group.begin(), targets_.of_group.end(), targets_.loose);
  ledger.shift = targets_.shift;
  ledger.lost = targets_.lost;
  ledger.n_components = groups_.n;
  return ledger;
}

namespace {
/// Distance from a drop to the liquid component that it has left, at most [cells].
constexpr int leaving_reach = 3;

/// The part of what is wanted that there is.
double part_of(double there, double wanted) {
  return wanted > 0 ? std::clamp(there / wanted, 0.0, 1.0) : 0;
}
}  // namespace

template <int dim>
std::vector<double> VolumeLedger<dim>::take_drops(const SolidCells<dim>& solids,
                                                  const CellField& phi,
                                                  const std::vector<int>& cells, double volume) {
  const Communicator& comm = domain_.grid.comm();
  std::vector<double> parts(cells.size(), 0);
  if (sum_all(comm, static_cast<GlobalIndex>(cells.size())) == 0 || groups_.n == 0)
    return parts;
  std::vector<int> nearest = groups_.of_cell;
  spread_labels(domain_, solids, phi, leaving_reach, nearest);
  std::vector<double> wanted(groups_.n, 0);
  GlobalIndex n_far = 0;
  for (const int cell : cells) {
    if (nearest[cell] >= 0)
      wanted[nearest[cell]] += volume;
    else
      ++n_far;
  }
  sum_over_ranks(comm, wanted);
  std::vector<double> part(groups_.n);
  for (int body = 0; body < groups_.n; ++body) {
    part[body] = part_of(targets_.of_group[body], wanted[body]);
    targets_.of_group[body] -= part[body] * wanted[body];
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (nearest[cells[i]] >= 0)
      parts[i] = part[nearest[cells[i]]];
  if (sum_all(comm, n_far) == 0)
    return parts;

  const CellGroups& spaces = find_closed_spaces(domain_, solids);
  const std::vector<int> space = places_among(domain_, spaces, groups_);
  std::vector<double> wanted_in(spaces.n, 0), there(spaces.n, 0);
  for (const int cell : cells)
    if (nearest[cell] < 0 && spaces.of_cell[cell] >= 0)
      wanted_in[spaces.of_cell[cell]] += volume;
  sum_over_ranks(comm, wanted_in);
  for (int body = 0; body < groups_.n; ++body)
    there[space[body]] += std::max(targets_.of_group[body], 0.0);
  for (int body = 0; body < groups_.n; ++body) {
    const int in = space[body];
    if (there[in] > 0 && targets_.of_group[body] > 0)
      targets_.of_group[body] *= 1 - std::min(wanted_in[in] / there[in], 1.0);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int in = spaces.of_cell[cells[i]];
    if (nearest[cells[i]] < 0 && in >= 0)
      parts[i] = part_of(there[in], wanted_in[in]);
  }
  return parts;
}

template <int dim>
void VolumeLedger<dim>::give_drops(const std::vector<int>& cells,
                                   const std::vector<double>& volumes) {
  const Communicator& comm = domain_.grid.comm();
  if (sum_all(comm, static_cast<GlobalIndex>(cells.size())) == 0)
    return;
  std::vector<double> given(groups_.n, 0);
  for (std::size_t i = 0; i < cells.size(); ++i)
    given[groups_.of_cell[cells[i]]] += volumes[i];
  sum_over_ranks(comm, given);
  for (int body = 0; body < groups_.n; ++body)
    targets_.of_group[body] += given[body];
}

template std::vector<int> places_among(const MacDomain<2>&, const CellGroups&, const CellGroups&);
template std::vector<int> places_among(const MacDomain<3>&, const CellGroups&, const CellGroups&);
template class VolumeLedger<2>;
template class VolumeLedger<3>;

}  // namespace lockstep
