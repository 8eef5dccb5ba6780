#include "mac/parts/prescribed_sides.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "staggered/state/face_moments.hpp"

namespace lockstep {

namespace {

/// Calls f(axis, end, side) for the sides that fluid enters or leaves through at a given velocity.
template <int dim, typename Function>
void for_each_inflow(const Boundary<dim>& boundary, const Function& f) {
  for (int axis = 0; axis < dim; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = boundary.side(axis, end);
      if (side.type == SideType::inflow && side.moves())
        f(axis, end, side);
    }
  }
}

}  // namespace

template <int dim>
std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<dim>& domain,
                                            const MacGeometry<dim>& geometry, double time) {
  std::vector<PrescribedFlux> fluxes;
  for_each_inflow(domain.boundary, [&](int axis, int end, const BoundarySide<dim>& side) {
    fluxes.push_back({fmt::format("the inflow \"{}\"", side_name(axis, end)), {}});
    for (const auto& [face_axis, cell] : geometry.prescribed) {
      const bool is_upper = geometry.state.cells[cell] == CellState::outside;
      if (face_axis != axis || is_upper != (end == 1))
        continue;
      const double velocity =
          side.mean_velocity(axis, domain.face_box(axis, cell), time)[axis] * (is_upper ? -1 : 1);
      const int fluid = is_upper ? domain.grid.neighbor(cell, axis, 0) : cell;
      const double area = geometry.face_table.area() * geometry.flux_fraction(axis, cell);
      if (velocity != 0)
        fluxes.back().into.emplace_back(geometry.unknown[fluid], area * velocity);
    }
  });
  return fluxes;
}

namespace {
/// Square of the velocity along an open side, the mean over the faces of the cell beside it.
template <int dim>
double speed_along_2(const TiledGrid<dim>& grid, const FaceField<dim>& velocity, int axis,
                     int cell) {
  double sum = 0;
  for (int a = 0; a < dim; ++a) {
    const int upper = grid.neighbor(cell, a, 1);
    const double mean = 0.5 * (velocity[a][cell] + (upper < 0 ? 0 : velocity[a][upper]));
    sum += a == axis ? 0 : mean * mean;
  }
  return sum;
}

/// Change of the velocity inwards by which a side takes the head u^2/2 that fluid which comes in at
/// `inwards` > 0 [m/s] has gained on its way from rest; none where it goes out. It never turns the
/// flow: in steps in which fluid comes in by more than a cell it is less.
double loss_of_inflow(const FaceProperties& face, double inwards, double along_2, double step) {
  if (inwards <= 0)
    return 0;
  return -0.5 * face.distance_factor * std::min(step * (inwards * inwards + along_2), inwards);
}

struct FaceSide {
  int axis, end;
};

/// The surface of a liquid, as it comes to stand at the sides.
template <int dim>
struct RisingSurface {
  const CellField& phi;            ///< signed distance, negative in the liquid [m]
  const FaceField<dim>& velocity;  ///< [m/s]
  double lead = 0;                 ///< time by which it goes on with the velocity [s]
  bool has_gas = false;            ///< the air above it is fluid, too
};

/// The part of the cell beside a face that is liquid [cells]. Massless air has no faces here: below
/// it the cell at the surface has that of the cell above, too, up to where the surface crosses the
/// line of their centres.
double wet_height(double phi, double spacing, bool has_gas) {
  const double height = 0.5 - phi / spacing;
  if (has_gas)
    return std::clamp(height, 0.0, 1.0);
  return height < 1.5 ? height : 1;
}

/// Signed distance of a cell's centre from the surface that goes on for the lead [m].
template <int dim>
double height_over(const TiledGrid<dim>& grid, const RisingSurface<dim>& surface,
                   const Point<dim>& up, int cell) {
  double rise = 0;  // [m/s]
  for (int a = 0; a < dim; ++a) {
    const int above = grid.neighbor(cell, a, 1);
    const double lower = surface.velocity[a][cell];
    rise += 0.5 * up[a] * (lower + (above < 0 ? lower : surface.velocity[a][above]));
  }
  return surface.phi[cell] - surface.lead * rise;
}

/// Area below the surface at a side that sends waves, and what comes in through it in a time.
template <int dim>
std::pair<double, double> wet_inflow(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                     const RisingSurface<dim>& surface, double time, FaceSide at) {
  const BoundarySide<dim>& side = domain.boundary.side(at.axis, at.end);
  double area = 0, into = 0;  // [m^(dim-1)], [m^dim/s]
  for (const auto& [axis, cell] : geometry.prescribed) {
    const bool is_upper = geometry.state.cells[cell] == CellState::outside;
    if (axis != at.axis || is_upper != (at.end == 1))
      continue;
    const int fluid = is_upper ? domain.grid.neighbor(cell, axis, 0) : cell;
    const double phi = height_over<dim>(domain.grid, surface, side.wave->up, fluid);
    const double wet = geometry.face_table.area() * geometry.flux_fraction(axis, cell) *
                       wet_height(phi, domain.spacing(), surface.has_gas);
    area += wet;
    into += wet * side.mean_velocity(axis, domain.face_box(axis, cell), time)[axis];
  }
  sum_over_ranks(domain.grid.comm(), area, into);
  return {area, at.end == 0 ? into : -into};
}
}  // namespace

template <int dim>
void balance_waves(double lead, MacFlow<dim>& flow) {
  if (!flow.liquid)
    return;
  const InterfaceModel<dim>& interface = flow.liquid->interface();
  const RisingSurface<dim> surface{interface.distance(), flow.velocity,
                                   interface.moves_by_fluxes() ? lead : 0, flow.liquid->has_gas()};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end) {
      auto& wave = flow.domain.boundary.sides[axis][end].wave;
      if (!wave)
        continue;
      wave->stream = 0;
      const auto [area, into] =
          wet_inflow<dim>(flow.domain, flow.geometry, surface, flow.time, {axis, end});
      double width = 1;  // [m]; in the plane that of a slice
      for (int a = 0; a < dim; ++a)
        if (a != axis && wave->up[a] == 0)
          width *= flow.domain.bounds().sizes()[a];
      if (area > 0)
        wave->stream = (wave->flow(flow.time) * width - into) / area;
    }
}

template <int dim>
Momentum<dim> push_of_pressures(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                double time, double dt, const FaceField<dim>& last,
                                FaceField<dim>& velocity) {
  Momentum<dim> mine;
  const double per_cell = dt / domain.spacing();
  for (int axis = 0; axis < dim; ++axis) {
    const auto& sides = domain.boundary.sides[axis];
    if (sides[0].pressure.vanishes() && sides[1].pressure.vanishes())
      continue;
    FaceMoments<dim> moments(domain.grid, axis);
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (geometry.state.faces[axis][cell] != FaceState::free)
        return;
      const FaceCells beside = cells_of_face(domain.grid, geometry.state.cells, axis, cell);
      if (!beside.at_side())
        return;
      const BoundarySide<dim>& side = sides[beside.lower < 0 ? 0 : 1];
      if (side.pressure.vanishes())
        return;
      const FaceProperties& face = geometry.face_table(axis, cell);
      const double inward = beside.lower < 0 ? 1 : -1;
      const double pressure = side.pressure(0, domain.grid.face_center(axis, cell), time);
      const double along_2 =
          speed_along_2<dim>(domain.grid, last, axis, std::max(beside.lower, beside.upper));
      const double loss = loss_of_inflow(face, inward * velocity[axis][cell], along_2, per_cell);
      const double change = inward * (dt * face.gradient * pressure + loss);
      velocity[axis][cell] += change;
      moments.add(cell, geometry.mass(axis, cell) * change);
    });
    mine += moments.total();
  }
  return mine;
}

template <int dim>
std::vector<std::pair<std::string, std::string>> notes_of_inflows(
    const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  std::vector<std::pair<std::string, std::string>> notes;
  for_each_inflow(domain.boundary, [&](int axis, int end, const BoundarySide<dim>& side) {
    if (side.wave) {
      const double length = side.wave->theory->length();
      notes.emplace_back("inflow " + side_name(axis, end),
                         fmt::format("waves {:.6g} m long ({:.3g} cells), {:.6g} m/s fast", length,
                                     length / domain.spacing(), side.wave->theory->speed()));
      return;
    }
    double open_area = 0;
    int n_open = 0, n_partial = 0;  // faces
    for (const auto& [face_axis, cell] : geometry.prescribed) {
      const bool is_upper = geometry.state.cells[cell] == CellState::outside;
      if (face_axis != axis || is_upper != (end == 1))
        continue;
      Box<dim> part;
      const double open = side.opening.share(axis, domain.face_box(axis, cell), part);
      open_area += open * geometry.face_table.area();
      n_open += open > 0;
      n_partial += open > 0 && open < 1;
    }
    sum_over_ranks(domain.grid.comm(), open_area, n_open, n_partial);
    const std::string rate =
        side.velocity.is_number(axis)
            ? fmt::format("{:.6g} m^{}/s",
                          std::abs(side.velocity(axis, domain.grid.lower(), 0)) * open_area, dim)
            : "by formula";
    notes.emplace_back("inflow " + side_name(axis, end),
                       fmt::format("{} through {:.6g} m^{}: {} faces, {} of them in part", rate,
                                   open_area, dim - 1, n_open, n_partial));
  });
  return notes;
}

template void balance_waves<2>(double, MacFlow<2>&);
template void balance_waves<3>(double, MacFlow<3>&);
template Momentum<2> push_of_pressures<2>(const MacDomain<2>&, const MacGeometry<2>&, double,
                                          double, const FaceField<2>&, FaceField<2>&);
template Momentum<3> push_of_pressures<3>(const MacDomain<3>&, const MacGeometry<3>&, double,
                                          double, const FaceField<3>&, FaceField<3>&);
template std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<2>&, const MacGeometry<2>&,
                                                     double);
template std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<3>&, const MacGeometry<3>&,
                                                     double);
template std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<2>&,
                                                                           const MacGeometry<2>&);
template std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<3>&,
                                                                           const MacGeometry<3>&);

}  // namespace lockstep
