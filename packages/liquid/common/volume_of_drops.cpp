// The part of VolumeLedger that exchanges volume with drops.
#include <algorithm>
#include <numeric>

#include "liquid/common/volume_ledger.hpp"

namespace lockstep {

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
  const std::vector<int> space = places_among(spaces, groups_);
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

template std::vector<double> VolumeLedger<2>::take_drops(const SolidCells<2>&, const CellField&,
                                                         const std::vector<int>&, double);
template std::vector<double> VolumeLedger<3>::take_drops(const SolidCells<3>&, const CellField&,
                                                         const std::vector<int>&, double);
template void VolumeLedger<2>::give_drops(const std::vector<int>&, const std::vector<double>&);
template void VolumeLedger<3>::give_drops(const std::vector<int>&, const std::vector<double>&);

}  // namespace lockstep
