#include "cutcell/flux_shares.hpp"

#include <algorithm>
#include <cmath>

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

/// Soft bodies: the points of their surface in and around the dual cell move the face.
template <int dim>
void add_soft_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                     const ClosedPart<dim>& part, double weight,
                     std::vector<FluxShare<dim>>& shares) {
  const bool at_surface = surface.solids()[part.solid].is_soft_body();
  const std::vector<SurfaceShare<dim>> around = surface_shares<dim>({volume}, surface).front();
  double total = 0;
  for (const SurfaceShare<dim>& share : around)
    total += share.solid == part.solid ? share.weight : 0;
  if (total == 0) {
    shares.push_back({weight, surface.closest_on_solid(part.center, part.solid), part.solid,
                      part.center, at_surface});
    return;
  }
  for (const SurfaceShare<dim>& share : around)
    if (share.solid == part.solid)
      shares.push_back(
          {weight * share.weight / total, share.point, part.solid, part.center, at_surface});
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

/// The shells between the pressure points, in ascending order, by the half-open decision that the
/// crossings of the lattice of cell centres use.
template <int dim>
std::vector<int> shells_between(const ControlVolume<dim>& volume,
                                const SurfaceSnapshot<dim>& surface) {
  if (volume.at_prescribed_side)
    return {};  // one pressure point
  const int axis = volume.direction;
  const Point<dim> from = volume.sides[0].center, to = volume.sides[1].center;
  std::vector<int> found, shells;
  surface.touching(Box<dim>(from, to), found);
  Crossing<dim> crossing;
  for (const int s : found)
    if (!surface.solids()[surface.solid_of(s)].closed &&
        cross_line<dim>(surface.corners(s), axis, from, crossing) &&
        crossing.coordinate > from[axis] && crossing.coordinate <= to[axis])
      shells.push_back(surface.solid_of(s));
  std::sort(shells.begin(), shells.end());
  shells.erase(std::unique(shells.begin(), shells.end()), shells.end());
  return shells;
}

/// The shares of the shells that block a face, or, without any, of all solids in its dual cell.
template <int dim>
std::vector<SurfaceShare<dim>> thin_shares(const ControlVolume<dim>& volume,
                                           const SurfaceSnapshot<dim>& surface,
                                           const std::vector<int>& shells) {
  std::vector<SurfaceShare<dim>> shares = surface_shares<dim>({volume}, surface).front();
  if (shells.empty())
    return shares;
  const auto is_other = [&](const SurfaceShare<dim>& share) {
    return !std::binary_search(shells.begin(), shells.end(), share.solid);
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

template <int dim>
bool has_open_area(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface) {
  double open = volume.area;
  for (const auto& part : closed_parts<dim>(surface, face_of<dim>(volume), volume.direction))
    open -= part.area;
  return open > 1e-9 * volume.area;
}

/// Gives what several solids close to the one whose cell is beside the face, if there is one.
template <int dim>
void give_to_solid_beside(const ControlVolume<dim>& volume, std::vector<ClosedPart<dim>>& parts) {
  const int solid = solid_beside(volume);
  const auto is_of_other = [&](const ClosedPart<dim>& part) { return part.solid != solid; };
  if (solid < 0 || std::none_of(parts.begin(), parts.end(), is_of_other))
    return;
  ClosedPart<dim> all{solid, 0, volume.center};
  for (const ClosedPart<dim>& part : parts)
    all.area += part.area;
  parts.assign(1, all);
}

}  // namespace

template <int dim>
Box<dim> face_of(const ControlVolume<dim>& volume) {
  Box<dim> face = volume.box;
  face.min()[volume.direction] = face.max()[volume.direction] = volume.center[volume.direction];
  return face;
}

template <int dim>
double open_fraction_of(const ControlVolume<dim>& volume, bool parted,
                        const SurfaceSnapshot<dim>& surface, const FluxOptions& options) {
  double closed = 0;
  for (const ClosedPart<dim>& part : parts_of<dim>(volume, surface, options.weights))
    closed += part.area / volume.area;
  // Steps of which a float holds the sum over the faces of a cell exactly: in the single precision
  // of the stencils, rows of A must add up to zero.
  constexpr double steps = 1 << 20;
  const double open = std::round(steps * std::max(0., 1 - closed)) / steps;
  // A body that sticks through a wall by less has its motion change the volume of closed fluid by
  // next to nothing, at next to infinite pressures.
  if (volume.at_prescribed_side && 1 - open < options.smallest_open_fraction)
    return 1;
  if (parted && (options.weights == FaceWeights::areas || has_open_area<dim>(volume, surface)))
    return 0;
  if (open < options.smallest_open_fraction || !shells_between<dim>(volume, surface).empty())
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
                            const FluxOptions& options) {
  auto parts = parts_of<dim>(volume, surface, options.weights);
  double closed = 0;
  for (const ClosedPart<dim>& part : parts)
    closed += part.area / volume.area;
  const bool is_closed = volume.open_fraction == 0;
  if (is_closed)
    give_to_solid_beside<dim>(volume, parts);
  FaceShares<dim> result;
  double total = closed;
  if (is_closed) {
    const std::vector<int> shells = shells_between<dim>(volume, surface);
    if (!shells.empty() || 1 - closed >= options.smallest_open_fraction) {
      result.of_thin = thin_shares<dim>(volume, surface, shells);
      result.thin_part = std::max(0., 1 - closed);
      total = std::max(closed, 1.);
    }
  }
  LOCKSTEP_ASSERT(total > 0);
  for (const ClosedPart<dim>& part : parts) {
    const double weight = part.area / volume.area / total;
    if (surface.solids()[part.solid].rigid)
      result.all.push_back(
          {weight, representative<dim>(surface, part.solid, part.center), part.solid, part.center});
    else
      add_soft_shares<dim>(volume, surface, part, weight, result.all);
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
template double open_fraction_of<2>(const ControlVolume<2>&, bool, const SurfaceSnapshot<2>&,
                                    const FluxOptions&);
template double open_fraction_of<3>(const ControlVolume<3>&, bool, const SurfaceSnapshot<3>&,
                                    const FluxOptions&);
template Point<2> open_center_of<2>(const ControlVolume<2>&, const std::vector<FluxShare<2>>&);
template Point<3> open_center_of<3>(const ControlVolume<3>&, const std::vector<FluxShare<3>>&);
template FaceShares<2> face_shares<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&,
                                      const FluxOptions&);
template FaceShares<3> face_shares<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&,
                                      const FluxOptions&);

}  // namespace lockstep
