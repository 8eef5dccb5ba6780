#include "mixedface/lumping.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/solid_volume.hpp"

namespace lockstep {

template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell) {
  std::vector<double> masses(volumes.size());
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const double whole = volumes[f].box.volume();
    const double solid = whole_cell ? 0 : solid_volume_in_box<dim>(surface, volumes[f].box);
    masses[f] = volumes[f].density * std::max(0., whole - solid);
  }
  return masses;
}

namespace {

/// Per solid and axis: normal matrix of (1, t), lumped mass and moments, displaced mass and
/// moments, and whether every column of the solid closes (lower and upper face areas cancel).
template <int dim>
struct AxisBalance {
  using Small = Eigen::Matrix<double, dim, dim>;
  using Values = Eigen::Matrix<double, dim, 1>;
  Small normal = Small::Zero();
  Values displaced = Values::Zero();
  double open_area = 0, area = 0;
};

/// (1, transverse coordinates relative to the solid's centre).
template <int dim>
Eigen::Matrix<double, dim, 1> moments_of(const Point<dim>& arm, int axis) {
  Eigen::Matrix<double, dim, 1> m;
  m[0] = 1;
  for (int k = 1; k < dim; ++k)
    m[k] = arm[(axis + k) % dim];
  return m;
}

template <int dim>
using SolidBalance = std::array<AxisBalance<dim>, dim>;

template <int dim>
std::vector<SolidBalance<dim>> accumulate(const std::vector<ControlVolume<dim>>& volumes,
                                          const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                          const std::vector<Point<dim>>& centers,
                                          const std::vector<double>& masses,
                                          const Communicator& comm) {
  std::vector<SolidBalance<dim>> balances(centers.size());
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const ControlVolume<dim>& volume = volumes[f];
    const int a = volume.direction;
    for (const SurfaceShare<dim>& share : shares[f]) {
      const Point<dim> arm = volume.center - centers[share.solid];
      const auto m = moments_of<dim>(arm, a);
      AxisBalance<dim>& balance = balances[share.solid][a];
      balance.normal += share.weight * masses[f] * m * m.transpose();
      // The discrete pressure p = x_a pushes with area (x_upper - x_lower) on the pair of cells.
      for (int side = 0; side < 2; ++side) {
        if (volume.sides[side].unknown == no_index)
          continue;
        const double sign = side == 0 ? -1 : 1;
        const double height = volume.sides[side].center[a] - centers[share.solid][a];
        balance.displaced += share.weight * volume.area * sign * height * m;
        balance.open_area += share.weight * volume.area * sign;
      }
      balance.area += share.weight * volume.area;
    }
  }
  std::vector<double> flat;
  const int stride = dim * dim + dim + 2;
  flat.reserve(balances.size() * dim * stride);
  for (const auto& solid : balances) {
    for (const auto& axis : solid) {
      flat.insert(flat.end(), axis.normal.data(), axis.normal.data() + dim * dim);
      flat.insert(flat.end(), axis.displaced.data(), axis.displaced.data() + dim);
      flat.push_back(axis.open_area);
      flat.push_back(axis.area);
    }
  }
  if (!flat.empty())
    sum_all(comm, flat.data(), static_cast<int>(flat.size()));
  const double* value = flat.data();
  for (auto& solid : balances) {
    for (auto& axis : solid) {
      std::copy(value, value + dim * dim, axis.normal.data());
      std::copy(value + dim * dim, value + dim * dim + dim, axis.displaced.data());
      axis.open_area = value[dim * dim + dim];
      axis.area = value[dim * dim + dim + 1];
      value += stride;
    }
  }
  return balances;
}

/// True if `factor` keeps the masses of all faces of this solid and axis positive, on all ranks.
template <int dim>
bool stays_positive(const std::vector<ControlVolume<dim>>& volumes,
                    const std::vector<std::vector<SurfaceShare<dim>>>& shares, int solid, int axis,
                    const Point<dim>& center, const Eigen::Matrix<double, dim, 1>& factor,
                    const std::vector<double>& masses, const Communicator& comm) {
  double smallest = 1;
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (volumes[f].direction != axis || masses[f] <= 0)
      continue;
    for (const SurfaceShare<dim>& share : shares[f]) {
      if (share.solid != solid)
        continue;
      smallest =
          std::min(smallest, 1 + factor.dot(moments_of<dim>(volumes[f].center - center, axis)));
    }
  }
  return min_all(comm, smallest) > 0;
}

template <int dim>
void scale_masses(const std::vector<ControlVolume<dim>>& volumes,
                  const std::vector<std::vector<SurfaceShare<dim>>>& shares, int solid, int axis,
                  const Point<dim>& center, const Eigen::Matrix<double, dim, 1>& factor,
                  const std::vector<double>& original, std::vector<double>& masses) {
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (volumes[f].direction != axis)
      continue;
    for (const SurfaceShare<dim>& share : shares[f]) {
      if (share.solid != solid)
        continue;
      masses[f] += share.weight * original[f] *
                   factor.dot(moments_of<dim>(volumes[f].center - center, axis));
    }
  }
}

}  // namespace

template <int dim>
std::vector<UnseenMass<dim>> balance_masses(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SurfaceSnapshot<dim>& surface,
    double density, const Box<dim>& domain, const Communicator& comm, std::vector<double>& masses) {
  const auto& solids = surface.solids();
  std::vector<Point<dim>> centers(solids.size(), Point<dim>::Zero());
  std::vector<double> solid_volumes(solids.size(), 0);
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!solids[s].closed || solids[s].prescribed)
      continue;
    const PartOfSolid<dim> part = part_of_solid<dim>(surface, static_cast<int>(s), domain);
    centers[s] = part.centroid;
    solid_volumes[s] = part.volume;
  }
  const auto balances = accumulate<dim>(volumes, shares, centers, masses, comm);
  const std::vector<double> original = masses;
  std::vector<UnseenMass<dim>> unseen;
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!solids[s].closed || solids[s].prescribed)
      continue;
    UnseenMass<dim> left;
    left.solid = static_cast<int>(s);
    left.center = centers[s];
    bool any_left = false;
    for (int a = 0; a < dim; ++a) {
      const AxisBalance<dim>& balance = balances[s][a];
      // A column that ends at a wall has no lift of its own to balance.
      if (std::abs(balance.open_area) > 1e-9 * balance.area)
        continue;
      using Values = Eigen::Matrix<double, dim, 1>;
      Values excess = balance.normal.col(0) - density * balance.displaced;  // lumped minus wanted
      excess[0] += density * solid_volumes[s];
      const Values factor = balance.normal.completeOrthogonalDecomposition().solve(-excess);
      const double unsolved = (balance.normal * factor + excess).norm();
      const bool solvable = unsolved <= 1e-9 * (excess.norm() + 1e-300) &&
                            stays_positive<dim>(volumes, shares, static_cast<int>(s), a, centers[s],
                                                factor, original, comm);
      if (solvable) {
        scale_masses<dim>(volumes, shares, static_cast<int>(s), a, centers[s], factor, original,
                          masses);
      } else {
        any_left = true;
        left.mass[a] = excess[0];
        for (int k = 1; k < dim; ++k)
          left.moment(a, (a + k) % dim) = excess[k];
      }
    }
    if (any_left)
      unseen.push_back(left);
  }
  return unseen;
}

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
  VelocityRow<dim> scratch;
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
  const std::vector<GlobalIndex> carried = carried_dofs<dim>(volumes, shares, solids);
  const auto is_carried = [&carried](GlobalIndex dof) {
    return std::binary_search(carried.begin(), carried.end(), dof);
  };
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    for (const SurfaceShare<dim>& share : shares[f]) {
      const bool is_rigid = solids.solids()[share.solid].rigid;
      if (is_rigid && lumping == Lumping::paper_diagonal)
        continue;  // done body by body
      directed_row<dim>(solids, share.point, volumes[f].center, volumes[f].direction, scratch, dofs,
                        values);
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

template std::vector<double> fluid_masses<2>(const std::vector<ControlVolume<2>>&,
                                             const SurfaceSnapshot<2>&, bool);
template std::vector<double> fluid_masses<3>(const std::vector<ControlVolume<3>>&,
                                             const SurfaceSnapshot<3>&, bool);
template std::vector<UnseenMass<2>> balance_masses<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<std::vector<SurfaceShare<2>>>&,
    const SurfaceSnapshot<2>&, double, const Box<2>&, const Communicator&, std::vector<double>&);
template std::vector<UnseenMass<3>> balance_masses<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<std::vector<SurfaceShare<3>>>&,
    const SurfaceSnapshot<3>&, double, const Box<3>&, const Communicator&, std::vector<double>&);
template std::vector<Triplet> added_mass_triplets<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<std::vector<SurfaceShare<2>>>&,
    const SolidSystem<2>&, const std::vector<double>&, Lumping);
template std::vector<Triplet> added_mass_triplets<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<std::vector<SurfaceShare<3>>>&,
    const SolidSystem<3>&, const std::vector<double>&, Lumping);

}  // namespace lockstep
