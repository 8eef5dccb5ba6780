#include "cutcell/displaced_volume.hpp"

#include <cmath>

#include "geometry/solid_volume.hpp"

namespace lockstep {
namespace {

/// V sum (1 - alpha) of one solid along one axis, its first moments about the solid's centroid, and
/// the areas of its faces: signed, of those beside a pressure, they cancel if every column ends in
/// the fluid.
template <int dim>
struct Displaced {
  double volume = 0;
  Point<dim> moment = Point<dim>::Zero();
  double open_area = 0, area = 0;
};
template <int dim>
using DisplacedOfSolid = std::array<Displaced<dim>, dim>;

template <int dim>
void add_face(const ControlVolume<dim>& volume, const FluxShare<dim>& share,
              const Point<dim>& center, Displaced<dim>& sum) {
  const int a = volume.direction;
  const double area = share.weight * (1 - volume.open_fraction) * volume.area;
  sum.area += area;
  Point<dim> arm = share.center - center;
  arm[a] = 0;
  // The pressure p = x_a pushes with area (x_upper - x_lower) on the cells of the face.
  for (int side = 0; side < 2; ++side) {
    if (volume.sides[side].unknown == no_index)
      continue;
    const double sign = side == 0 ? -1 : 1;
    const double lifted = sign * area * (volume.sides[side].center[a] - center[a]);
    sum.volume += lifted;
    sum.moment += lifted * arm;
    sum.open_area += sign * area;
  }
}

/// Returns -g/|g|, the slope of a free surface at rest: a hydrostatic force along an axis, divided
/// by rho |g| and by this component, is the displaced volume, wherever the plane of moving water
/// lies. 0 along level axes, and without gravity.
template <int dim>
Point<dim> slope_at_rest(const Point<dim>& gravity) {
  Point<dim> slope = gravity.isZero(0) ? gravity : Point<dim>(-gravity.normalized());
  for (int a = 0; a < dim; ++a)
    if (std::abs(slope[a]) < 1e-6)
      slope[a] = 0;
  return slope;
}

/// Adds a face of a body that sticks out of the water: the hydrostatic pressure is the depth below
/// the plane of the free surface, 0 above it. Not along level axes.
template <int dim>
void add_wet_face(const ControlVolume<dim>& volume, const FluxShare<dim>& share,
                  const WetBody<dim>& body, const Point<dim>& at_rest, Displaced<dim>& sum) {
  const int a = volume.direction;
  if (at_rest[a] == 0)
    return;
  Point<dim> arm = share.center - body.centroid;
  arm[a] = 0;
  const double area = share.weight * (1 - volume.open_fraction) * volume.area;
  for (int side = 0; side < 2; ++side) {
    if (volume.sides[side].unknown == no_index)
      continue;
    const double lifted = (side == 0 ? 1 : -1) * area * body.depth(volume.sides[side].center);
    sum.volume += lifted / at_rest[a];
    sum.moment += lifted / at_rest[a] * arm;
  }
}

template <int dim>
void sum_over_ranks(std::vector<DisplacedOfSolid<dim>>& all, const Communicator& comm) {
  std::vector<double> flat;
  for (const auto& solid : all)
    for (const Displaced<dim>& d : solid) {
      flat.insert(flat.end(), {d.volume, d.open_area, d.area});
      flat.insert(flat.end(), d.moment.data(), d.moment.data() + dim);
    }
  if (flat.empty())
    return;
  sum_all(comm, flat.data(), static_cast<int>(flat.size()));
  const double* value = flat.data();
  for (auto& solid : all)
    for (Displaced<dim>& d : solid) {
      d.volume = *value++;
      d.open_area = *value++;
      d.area = *value++;
      for (int a = 0; a < dim; ++a)
        d.moment[a] = *value++;
    }
}

}  // namespace

template <int dim>
std::vector<DisplacedExcess<dim>> displaced_excess(
    const std::vector<ControlVolume<dim>>& volumes, const std::vector<FaceShares<dim>>& shares,
    const std::vector<double>& lumped_masses, const SurfaceSnapshot<dim>& surface, double density,
    const Box<dim>& domain, const Point<dim>& gravity, const std::vector<WetBody<dim>>& wet,
    const Communicator& comm) {
  const Point<dim> at_rest = slope_at_rest<dim>(gravity);
  const int n_solids = static_cast<int>(surface.solids().size());
  const auto is_partly_wet = [&](int s) { return !wet.empty() && wet[s].partly; };
  std::vector<PartOfSolid<dim>> bodies(n_solids);
  for (int s = 0; s < n_solids; ++s) {
    if (!surface.solids()[s].closed)
      continue;
    bodies[s] = is_partly_wet(s) ? PartOfSolid<dim>{wet[s].volume, wet[s].centroid}
                                 : part_of_solid<dim>(surface, s, domain);
  }

  std::vector<DisplacedOfSolid<dim>> displaced(n_solids);
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    if (volumes[f].at_prescribed_side)
      continue;  // a column that ends there lifts nothing
    const int a = volumes[f].direction;
    for (const FluxShare<dim>& share : shares[f].all) {
      Displaced<dim>& sum = displaced[share.solid][a];
      if (is_partly_wet(share.solid))
        add_wet_face<dim>(volumes[f], share, wet[share.solid], at_rest, sum);
      else
        add_face<dim>(volumes[f], share, bodies[share.solid].centroid, sum);
    }
    for (const SurfaceShare<dim>& share : shares[f].of_thin) {
      const double volume = share.weight * lumped_masses[f] / density;
      Point<dim> arm = volumes[f].center - bodies[share.solid].centroid;
      arm[a] = 0;
      displaced[share.solid][a].volume -= volume;
      displaced[share.solid][a].moment -= volume * arm;
    }
  }
  sum_over_ranks<dim>(displaced, comm);

  std::vector<DisplacedExcess<dim>> all;
  for (int s = 0; s < n_solids; ++s)
    for (int a = 0; surface.solids()[s].closed && a < dim; ++a) {
      const Displaced<dim>& d = displaced[s][a];
      if (is_partly_wet(s)
              ? wet[s].at_side[a] || wet[s].volume <= 0 || at_rest[a] == 0 || wet[s].slope.isZero(0)
              : std::abs(d.open_area) > 1e-6 * d.area)
        continue;
      // On a partly wet body the pressure pushes along the slope of its water.
      const double wanted = is_partly_wet(s) ? wet[s].slope[a] / at_rest[a] : 1;
      all.push_back({s, a, bodies[s].centroid, density * (d.volume - wanted * bodies[s].volume),
                     density * d.moment});
    }
  return all;
}

template std::vector<DisplacedExcess<2>> displaced_excess<2>(
    const std::vector<ControlVolume<2>>&, const std::vector<FaceShares<2>>&,
    const std::vector<double>&, const SurfaceSnapshot<2>&, double, const Box<2>&, const Point<2>&,
    const std::vector<WetBody<2>>&, const Communicator&);
template std::vector<DisplacedExcess<3>> displaced_excess<3>(
    const std::vector<ControlVolume<3>>&, const std::vector<FaceShares<3>>&,
    const std::vector<double>&, const SurfaceSnapshot<3>&, double, const Box<3>&, const Point<3>&,
    const std::vector<WetBody<3>>&, const Communicator&);

}  // namespace lockstep
