#include "faces/added_mass.hpp"

#include <algorithm>
#include <numeric>

namespace lockstep {

namespace {

/// The rows of each column: faces and values.
struct Columns {
  std::vector<int> begin, faces;
  std::vector<double> values;
};
Columns columns_of(const CouplingWeights& weights) {
  Columns columns;
  columns.begin.assign(weights.dofs.size() + 1, 0);
  for (const int column : weights.columns)
    ++columns.begin[column + 1];
  std::partial_sum(columns.begin.begin(), columns.begin.end(), columns.begin.begin());
  std::vector<int> next(columns.begin.begin(), columns.begin.end() - 1);
  columns.faces.resize(weights.columns.size());
  columns.values.resize(weights.columns.size());
  for (int f = 0; f < weights.n_rows(); ++f) {
    for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k) {
      const int place = next[weights.columns[k]]++;
      columns.faces[place] = f;
      columns.values[place] = weights.values[k];
    }
  }
  return columns;
}

}  // namespace

// Row by row, each summed in place: the products of all faces one by one would need a hundred times
// the memory of what they add up to.
std::vector<Triplet> consistent_mass_triplets(const CouplingWeights& weights,
                                              const std::vector<double>& masses) {
  const Columns columns = columns_of(weights);
  const int n = static_cast<int>(weights.dofs.size());
  std::vector<Triplet> triplets;
  std::vector<double> sums(n, 0);
  std::vector<int> touched;
  std::vector<char> is_touched(n, 0);
  for (int i = 0; i < n; ++i) {
    touched.clear();
    for (int c = columns.begin[i]; c < columns.begin[i + 1]; ++c) {
      const int f = columns.faces[c];
      const double factor = masses[f] * columns.values[c];
      for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k) {
        const int j = weights.columns[k];
        if (!is_touched[j])
          touched.push_back(j);
        is_touched[j] = 1;
        sums[j] += factor * weights.values[k];
      }
    }
    std::sort(touched.begin(), touched.end());
    for (const int j : touched) {
      triplets.push_back({weights.dofs[i], weights.dofs[j], sums[j]});
      sums[j] = 0;
      is_touched[j] = 0;
    }
  }
  return triplets;
}

namespace {

/// The dofs of these shares that are combinations of others, ascending. Collective.
template <int dim>
std::vector<GlobalIndex> carried_dofs(const std::vector<ControlVolume<dim>>& volumes,
                                      const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                      const SolidSystem<dim>& solids) {
  if (!solids.reduction().has_combinations())
    return {};
  const CouplingWeights weights = coupling_weights<dim>(volumes, shares, solids, false);
  return solids.reduction().combinations_among(weights.dofs);
}

}  // namespace

template <int dim>
std::vector<Triplet> added_mass_triplets(const std::vector<ControlVolume<dim>>& volumes,
                                         const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                         const SolidSystem<dim>& solids,
                                         const std::vector<double>& masses, Lumping lumping) {
  if (lumping == Lumping::consistent)
    return consistent_mass_triplets(coupling_weights<dim>(volumes, shares, solids), masses);
  std::vector<Triplet> triplets;
  if (lumping == Lumping::paper_diagonal)
    triplets = paper_diagonal_triplets<dim>(volumes, shares, solids, masses);
  DirectedRow<dim> row;
  const std::vector<GlobalIndex>& dofs = row.dofs;
  const std::vector<double>& values = row.values;
  const std::vector<GlobalIndex> carried = carried_dofs<dim>(volumes, shares, solids);
  const auto is_carried = [&carried](GlobalIndex dof) {
    return std::binary_search(carried.begin(), carried.end(), dof);
  };
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    for (const SurfaceShare<dim>& share : shares[f]) {
      const bool is_rigid = solids.solids()[share.solid].rigid;
      if (is_rigid && lumping == Lumping::paper_diagonal)
        continue;  // done body by body
      directed_row<dim>(solids, share.point, volumes[f].center, volumes[f].direction, row);
      // A rigid motion, or that of an element with nodes that a rigid body carries.
      const bool is_rigid_motion =
          is_rigid || (!carried.empty() && std::any_of(dofs.begin(), dofs.end(), is_carried));
      const double mass = masses[f] * share.weight;
      for (std::size_t i = 0; i < dofs.size(); ++i) {
        if (!is_rigid_motion)
          triplets.push_back({dofs[i], dofs[i], mass * values[i]});
        for (std::size_t j = 0; is_rigid_motion && j < dofs.size(); ++j)
          triplets.push_back({dofs[i], dofs[j], mass * values[i] * values[j]});
      }
    }
  }
  return triplets;
}

template std::vector<Triplet> added_mass_triplets<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<std::vector<SurfaceShare<2>>>&,
    const SolidSystem<2>&, const std::vector<double>&, Lumping);
template std::vector<Triplet> added_mass_triplets<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<std::vector<SurfaceShare<3>>>&,
    const SolidSystem<3>&, const std::vector<double>&, Lumping);

}  // namespace lockstep
