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

/// The shells' shares of a face that they block.
template <int dim>
std::vector<SurfaceShare<dim>> shell_shares(const ControlVolume<dim>& volume,
                                            const SurfaceSnapshot<dim>& surface) {
  std::vector<SurfaceShare<dim>> shares = surface_shares<dim>({volume}, surface).front();
  shares.erase(std::remove_if(shares.begin(), shares.end(),
                              [&](const auto& s) { return surface.solids()[s.solid].closed; }),
               shares.end());
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

// The same half-open decision as for the crossings of the lattice of cell centres.
template <int dim>
bool blocked_by_shell(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface) {
  const int axis = volume.direction;
  const double lower = volume.sides[0].center[axis], upper = volume.sides[1].center[axis];
  const Box<dim> segment(volume.sides[0].center, volume.sides[1].center);
  std::vector<int> found;
  surface.touching(segment, found);
  Crossing<dim> crossing;
  return std::any_of(found.begin(), found.end(), [&](int s) {
    return !surface.solids()[surface.solid_of(s)].closed &&
           cross_line<dim>(surface.corners(s), axis, volume.sides[0].center, crossing) &&
           crossing.coordinate > lower && crossing.coordinate <= upper;
  });
}

template <int dim>
double open_fraction_of(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                        double smallest) {
  double closed = 0;
  for (const ClosedPart<dim>& part :
       closed_parts<dim>(surface, face_of<dim>(volume), volume.direction))
    closed += part.area / volume.area;
  // Steps of which a float holds the sum over the faces of a cell exactly: in the single precision
  // of the stencils, rows of A must add up to zero.
  constexpr double steps = 1 << 20;
  const double open = std::round(steps * std::max(0., 1 - closed)) / steps;
  if (open < smallest || blocked_by_shell<dim>(volume, surface))
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
FaceShares<dim> face_shares(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface) {
  const auto parts = closed_parts<dim>(surface, face_of<dim>(volume), volume.direction);
  const bool is_closed = volume.open_fraction == 0;
  const bool has_shell = is_closed && blocked_by_shell<dim>(volume, surface);
  double closed = 0;
  for (const ClosedPart<dim>& part : parts)
    closed += part.area / volume.area;
  FaceShares<dim> result;
  if (has_shell) {
    result.of_shells = shell_shares<dim>(volume, surface);
    result.shell_part = std::max(0., 1 - closed);
  }
  const double total = has_shell ? std::max(closed, 1.) : closed;
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
  for (const SurfaceShare<dim>& share : result.of_shells)
    result.all.push_back(
        {result.shell_part * share.weight, share.point, share.solid, volume.center});
  return result;
}

template Box<2> face_of<2>(const ControlVolume<2>&);
template Box<3> face_of<3>(const ControlVolume<3>&);
template bool blocked_by_shell<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&);
template bool blocked_by_shell<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&);
template double open_fraction_of<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&, double);
template double open_fraction_of<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&, double);
template Point<2> open_center_of<2>(const ControlVolume<2>&, const std::vector<FluxShare<2>>&);
template Point<3> open_center_of<3>(const ControlVolume<3>&, const std::vector<FluxShare<3>>&);
template FaceShares<2> face_shares<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&);
template FaceShares<3> face_shares<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&);

}  // namespace lockstep
