#include "cutcell/flux_shares.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/disjoint_sets.hpp"
#include "base/errors.hpp"
#include "geometry/line_crossing.hpp"

namespace lockstep {
namespace {

/// Some point of a solid that stands for all of it: rows of a rigid body do not depend on it.
template <int dim>
SurfacePoint<dim> representative(const SurfaceSnapshot<dim>& surface, int solid,
                                 const Point<dim>& x) {
  SurfacePoint<dim> point;
  point.simplex = surface.solids()[solid].simplex_begin;
  point.barycentric.setConstant(1. / dim);
  point.position = x;
  return point;
}

/// Deformable solids: the surface points of this solid in and around the dual cell.
template <int dim>
void add_deformable_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                           const ClosedPart<dim>& part, double weight,
                           std::vector<FluxShare<dim>>& shares) {
  const std::vector<SurfaceShare<dim>> around = surface_shares<dim>({volume}, surface).front();
  double total = 0;
  for (const SurfaceShare<dim>& share : around)
    total += share.solid == part.solid ? share.weight : 0;
  if (total == 0) {
    shares.push_back(
        {weight, surface.closest_on_solid(part.center, part.solid), part.solid, part.center});
    return;
  }
  for (const SurfaceShare<dim>& share : around)
    if (share.solid == part.solid)
      shares.push_back({weight * share.weight / total, share.point, part.solid, part.center});
}

/// Moves the shares so that their mean is the centre of the face.
template <int dim>
void center_on_face(const ControlVolume<dim>& volume, std::vector<FluxShare<dim>>& shares) {
  Point<dim> mean = Point<dim>::Zero();
  double total = 0;
  for (const FluxShare<dim>& share : shares) {
    mean += share.weight * share.center;
    total += share.weight;
  }
  if (total == 0)
    return;
  const Point<dim> shift = volume.center - mean / total;
  for (FluxShare<dim>& share : shares)
    share.center += shift;
}

template <int dim>
std::vector<ClosedPart<dim>> parts_of(const ControlVolume<dim>& volume,
                                      const SurfaceSnapshot<dim>& surface, FaceWeights weights) {
  return weights == FaceWeights::areas
             ? closed_parts<dim>(surface, face_of<dim>(volume), volume.direction)
             : closed_volumes<dim>(surface, volume.box, volume.direction);
}

/// True if the pressure points see the same place in the open part of the face: what lies between
/// them is the tip of a body, around which the fluid flows.
template <int dim>
bool leads_around(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface) {
  Point<dim> moment = Point<dim>::Zero();
  double open = volume.area;
  for (const auto& part : closed_parts<dim>(surface, face_of<dim>(volume), volume.direction)) {
    moment += part.area * (part.center - volume.center);
    open -= part.area;
  }
  if (open <= 0)
    return false;
  const Point<dim> place = volume.center - moment / open;
  return !surface.first_hit(volume.sides[0].center, place) &&
         !surface.first_hit(place, volume.sides[1].center);
}

struct SolidCrossing {
  double coordinate = 0;  ///< along the segment between the pressure points [m]
  int solid = -1;
};

/// Solids on a segment and how often they are entered and left: those that meet on it without a gap
/// are one, and where they meet nothing is left.
std::vector<std::pair<std::vector<int>, int>> joined_crossings(std::vector<SolidCrossing> all,
                                                               double length) {
  constexpr double touching = 1e-9;  // part of the segment [1]
  std::sort(all.begin(), all.end(), [](const SolidCrossing& a, const SolidCrossing& b) {
    return std::tie(a.coordinate, a.solid) < std::tie(b.coordinate, b.solid);
  });
  std::vector<int> solids;
  for (const SolidCrossing& one : all)
    solids.push_back(one.solid);
  std::sort(solids.begin(), solids.end());
  solids.erase(std::unique(solids.begin(), solids.end()), solids.end());
  const auto place = [&solids](int solid) {
    return static_cast<int>(std::lower_bound(solids.begin(), solids.end(), solid) - solids.begin());
  };
  DisjointSets sets(static_cast<int>(solids.size()));
  std::vector<int> n(solids.size(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool meets = k + 1 < all.size() && all[k].solid != all[k + 1].solid &&
                       all[k + 1].coordinate - all[k].coordinate <= touching * length;
    if (meets) {
      sets.join(place(all[k].solid), place(all[k + 1].solid));
      ++k;
      continue;
    }
    ++n[place(all[k].solid)];
  }
  std::map<int, std::pair<std::vector<int>, int>> joined;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    auto& [members, n_crossings] = joined[sets.root(static_cast<int>(i))];
    members.push_back(solids[i]);
    n_crossings += n[i];
  }
  std::vector<std::pair<std::vector<int>, int>> result;
  for (const auto& entry : joined) {
    if (entry.second.second > 0)
      result.push_back(entry.second);
  }
  return result;
}

/// The shares of thin parts in a face that they block.
template <int dim>
std::vector<SurfaceShare<dim>> thin_shares(const ControlVolume<dim>& volume,
                                           const SurfaceSnapshot<dim>& surface,
                                           const std::vector<int>& solids) {
  std::vector<SurfaceShare<dim>> shares = surface_shares<dim>({volume}, surface).front();
  const auto is_other = [&](const SurfaceShare<dim>& share) {
    return !std::binary_search(solids.begin(), solids.end(), share.solid);
  };
  shares.erase(std::remove_if(shares.begin(), shares.end(), is_other), shares.end());
  double total = 0;
  for (const SurfaceShare<dim>& share : shares)
    total += share.weight;
  LOCKSTEP_ASSERT(total > 0);
  for (SurfaceShare<dim>& share : shares)
    share.weight /= total;
  return shares;
}

}  // namespace

template <int dim>
Box<dim> face_of(const ControlVolume<dim>& volume) {
  Box<dim> face = volume.box;
  face.min()[volume.direction] = face.max()[volume.direction] = volume.center[volume.direction];
  return face;
}

// Finds the thin parts between the pressure points, by the half-open decision that the crossings of
// the lattice of cell centres use.
template <int dim>
std::vector<int> thin_between(const ControlVolume<dim>& volume,
                              const SurfaceSnapshot<dim>& surface) {
  if (volume.at_prescribed_side)
    return {};  // one pressure point
  const int axis = volume.direction;
  const Point<dim> from = volume.sides[0].center, to = volume.sides[1].center;
  std::vector<int> found;
  surface.touching(Box<dim>(from, to), found);
  std::vector<int> thin;
  std::vector<SolidCrossing> crossings;
  Crossing<dim> crossing;
  for (const int s : found)
    if (cross_line<dim>(surface.corners(s), axis, from, crossing) &&
        crossing.coordinate > from[axis] && crossing.coordinate <= to[axis]) {
      const int solid = surface.solid_of(s);
      if (surface.solids()[solid].closed)
        crossings.push_back({crossing.coordinate, solid});
      else
        thin.push_back(solid);
    }
  for (const auto& [solids, n] : joined_crossings(std::move(crossings), to[axis] - from[axis])) {
    if (n % 2 == 0 && !leads_around(volume, surface))
      thin.insert(thin.end(), solids.begin(), solids.end());
  }
  std::sort(thin.begin(), thin.end());
  thin.erase(std::unique(thin.begin(), thin.end()), thin.end());
  return thin;
}

template <int dim>
double open_fraction_of(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                        double smallest, FaceWeights weights) {
  double closed = 0;
  for (const ClosedPart<dim>& part : parts_of<dim>(volume, surface, weights))
    closed += part.area / volume.area;
  // Steps of which a float holds the sum over the faces of a cell exactly: in the single precision
  // of the stencils, rows of A must add up to zero.
  constexpr double steps = 1 << 20;
  const double open = std::round(steps * std::max(0., 1 - closed)) / steps;
  // A body that sticks through a wall by less has its motion change the volume of closed fluid by
  // next to nothing, at next to infinite pressures.
  if (volume.at_prescribed_side && 1 - open < smallest)
    return 1;
  if (open < smallest || !thin_between<dim>(volume, surface).empty())
    return 0;
  return open;
}

template <int dim>
Point<dim> open_center_of(const ControlVolume<dim>& volume,
                          const std::vector<FluxShare<dim>>& shares) {
  Point<dim> moment = Point<dim>::Zero();
  for (const FluxShare<dim>& share : shares)
    moment += share.weight * (share.center - volume.center);
  return volume.center - (1 - volume.open_fraction) / volume.open_fraction * moment;
}

template <int dim>
FaceShares<dim> face_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                            FaceWeights weights) {
  const auto parts = parts_of<dim>(volume, surface, weights);
  const bool is_closed = volume.open_fraction == 0;
  std::vector<int> thin;
  if (is_closed)
    thin = thin_between<dim>(volume, surface);
  double closed = 0;
  for (const ClosedPart<dim>& part : parts)
    closed += part.area / volume.area;
  FaceShares<dim> result;
  if (!thin.empty()) {
    result.of_thin = thin_shares<dim>(volume, surface, thin);
    result.thin_part = std::max(0., 1 - closed);
  }
  const double total = thin.empty() ? closed : std::max(closed, 1.);
  LOCKSTEP_ASSERT(total > 0);
  for (const ClosedPart<dim>& part : parts) {
    const double weight = part.area / volume.area / total;
    if (surface.solids()[part.solid].rigid)
      result.all.push_back(
          {weight, representative<dim>(surface, part.solid, part.center), part.solid, part.center});
    else
      add_deformable_shares<dim>(volume, surface, part, weight, result.all);
  }
  if (is_closed)
    center_on_face<dim>(volume, result.all);
  for (const SurfaceShare<dim>& share : result.of_thin)
    result.all.push_back(
        {result.thin_part * share.weight, share.point, share.solid, volume.center});
  return result;
}

template Box<2> face_of<2>(const ControlVolume<2>&);
template Box<3> face_of<3>(const ControlVolume<3>&);
template std::vector<int> thin_between<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&);
template std::vector<int> thin_between<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&);
template double open_fraction_of<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&, double,
                                    FaceWeights);
template double open_fraction_of<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&, double,
                                    FaceWeights);
template Point<2> open_center_of<2>(const ControlVolume<2>&, const std::vector<FluxShare<2>>&);
template Point<3> open_center_of<3>(const ControlVolume<3>&, const std::vector<FluxShare<3>>&);
template FaceShares<2> face_shares<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&,
                                      FaceWeights);
template FaceShares<3> face_shares<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&,
                                      FaceWeights);

}  // namespace lockstep
