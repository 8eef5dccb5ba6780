#include "mixedface/lumping.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "faces/wet_volume.hpp"
#include "geometry/solid_volume.hpp"
#include "linear/least_squares.hpp"

namespace lockstep {

template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell,
                                 const LiquidFluid<dim>* liquid) {
  std::vector<double> masses(volumes.size(), 0);
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    double fluid = 0;
    if (volumes[f].only_gas())
      continue;
    if (liquid)
      fluid = wet_volume<dim>(volumes[f], surface, whole_cell, *liquid);
    else
      fluid = volumes[f].box.volume() -
              (whole_cell ? 0 : solid_volume_in_box<dim>(surface, volumes[f].box));
    masses[f] = volumes[f].density * std::max(0., fluid);
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

/// The correction of the masses of one solid along one axis.
template <int dim>
struct MassFactor {
  int solid, axis;
  Point<dim> center;
  Eigen::Matrix<double, dim, 1> factor;
  bool solvable;
  Eigen::Matrix<double, dim, 1> excess;  ///< lumped minus wanted mass and its moments

  /// Change of a face's mass as a part of it [1].
  double at(const Point<dim>& x) const { return factor.dot(moments_of<dim>(x - center, axis)); }
};

/// Corrections by solid and axis; null: none.
template <int dim>
using CorrectionTable = std::vector<const MassFactor<dim>*>;

/// By solid and axis, those that keep the masses of all their faces positive, on all ranks.
template <int dim>
std::vector<double> smallest_factors(const std::vector<ControlVolume<dim>>& volumes,
                                     const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                     const CorrectionTable<dim>& correction,
                                     const std::vector<double>& masses, const Communicator& comm) {
  std::vector<double> smallest(correction.size(), 1);
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (masses[f] <= 0)
      continue;
    for (const SurfaceShare<dim>& share : shares[f]) {
      const int place = share.solid * dim + volumes[f].direction;
      if (correction[place])
        smallest[place] = std::min(smallest[place], 1 + correction[place]->at(volumes[f].center));
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, smallest.data(), static_cast<int>(smallest.size()), MPI_DOUBLE,
                MPI_MIN, raw_communicator(comm));
  return smallest;
}

template <int dim>
void scale_masses(const std::vector<ControlVolume<dim>>& volumes,
                  const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                  const CorrectionTable<dim>& correction, std::vector<double>& masses) {
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const double original = masses[f];
    for (const SurfaceShare<dim>& share : shares[f]) {
      if (const auto* one = correction[share.solid * dim + volumes[f].direction])
        masses[f] += share.weight * original * one->at(volumes[f].center);
    }
  }
}

/// Volume of a partly wet body that the discrete hydrostatic pressure lifts along an axis, and its
/// moments.
template <int dim>
Eigen::Matrix<double, dim, 1> displaced_by(const WetBody<dim>& body, const Point<dim>& center,
                                           int axis) {
  Eigen::Matrix<double, dim, 1> displaced;
  displaced[0] = body.displaced[axis];
  for (int k = 1; k < dim; ++k) {
    const int across = (axis + k) % dim;
    displaced[k] = body.moment[axis][across] - body.displaced[axis] * center[across];
  }
  return displaced;
}

/// Computes the corrections that balance each closed solid, along every axis on which its columns
/// close. The masses of prescribed solids need no factor: only their excess is used.
template <int dim>
std::vector<MassFactor<dim>> corrections_of(const std::vector<SolidDescription>& solids,
                                            const std::vector<SolidBalance<dim>>& balances,
                                            const std::vector<Point<dim>>& centers,
                                            const std::vector<double>& solid_volumes,
                                            const std::vector<WetBody<dim>>& wet, double density) {
  std::vector<MassFactor<dim>> corrections;
  for (int s = 0; s < static_cast<int>(solids.size()); ++s) {
    for (int a = 0; a < dim && solids[s].closed; ++a) {
      const AxisBalance<dim>& balance = balances[s][a];
      const bool partly_wet = !wet.empty() && wet[s].partly;
      // A column that ends at a wall has no lift of its own to balance.
      if (partly_wet ? wet[s].at_side[a] || wet[s].volume <= 0
                     : std::abs(balance.open_area) > 1e-9 * balance.area)
        continue;
      MassFactor<dim> one{s, a, centers[s], {}, false, {}};
      one.excess =
          balance.normal.col(0) -
          density * (partly_wet ? displaced_by<dim>(wet[s], centers[s], a) : balance.displaced);
      one.excess[0] += density * solid_volumes[s];
      if (!solids[s].prescribed) {
        one.factor = least_squares(balance.normal, -one.excess);
        const double unsolved = (balance.normal * one.factor + one.excess).norm();
        one.solvable = unsolved <= 1e-9 * (one.excess.norm() + 1e-300);
      }
      corrections.push_back(one);
    }
  }
  return corrections;
}

}  // namespace

template <int dim>
std::vector<DisplacedExcess<dim>> balance_masses(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SurfaceSnapshot<dim>& surface,
    double density, const Box<dim>& domain, const std::vector<WetBody<dim>>& wet,
    const Communicator& comm, std::vector<double>& masses) {
  const auto& solids = surface.solids();
  std::vector<Point<dim>> centers(solids.size(), Point<dim>::Zero());
  std::vector<double> solid_volumes(solids.size(), 0);
  for (std::size_t s = 0; s < solids.size(); ++s) {
    if (!solids[s].closed)
      continue;
    if (!wet.empty() && wet[s].partly) {
      centers[s] = wet[s].centroid;
      solid_volumes[s] = wet[s].volume;
      continue;
    }
    const PartOfSolid<dim> part = part_of_solid<dim>(surface, static_cast<int>(s), domain);
    centers[s] = part.centroid;
    solid_volumes[s] = part.volume;
  }
  const auto balances = accumulate<dim>(volumes, shares, centers, masses, comm);
  const auto corrections =
      corrections_of<dim>(solids, balances, centers, solid_volumes, wet, density);
  CorrectionTable<dim> correction(solids.size() * dim, nullptr);
  for (const MassFactor<dim>& one : corrections)
    correction[one.solid * dim + one.axis] = one.solvable ? &one : nullptr;
  const std::vector<double> smallest =
      smallest_factors<dim>(volumes, shares, correction, masses, comm);
  std::vector<DisplacedExcess<dim>> unseen;
  for (const MassFactor<dim>& one : corrections) {
    const std::size_t place = one.solid * dim + one.axis;
    if (correction[place] && smallest[place] > 0)
      continue;
    correction[place] = nullptr;
    DisplacedExcess<dim> left{one.solid, one.axis, one.center, -one.excess[0], Point<dim>::Zero()};
    for (int k = 1; k < dim; ++k)
      left.moment[(one.axis + k) % dim] = -one.excess[k];
    if (left.mass != 0 || !left.moment.isZero(0))
      unseen.push_back(left);
  }
  scale_masses<dim>(volumes, shares, correction, masses);
  return unseen;
}

template std::vector<double> fluid_masses<2>(const std::vector<ControlVolume<2>>&,
                                             const SurfaceSnapshot<2>&, bool,
                                             const LiquidFluid<2>*);
template std::vector<double> fluid_masses<3>(const std::vector<ControlVolume<3>>&,
                                             const SurfaceSnapshot<3>&, bool,
                                             const LiquidFluid<3>*);
template std::vector<DisplacedExcess<2>> balance_masses<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<std::vector<SurfaceShare<2>>>&,
    const SurfaceSnapshot<2>&, double, const Box<2>&, const std::vector<WetBody<2>>&,
    const Communicator&, std::vector<double>&);
template std::vector<DisplacedExcess<3>> balance_masses<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<std::vector<SurfaceShare<3>>>&,
    const SurfaceSnapshot<3>&, double, const Box<3>&, const std::vector<WetBody<3>>&,
    const Communicator&, std::vector<double>&);
}  // namespace lockstep
