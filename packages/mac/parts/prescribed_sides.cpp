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
/// Change of the velocity inwards by which a side takes the head rho u^2/2 that fluid which comes
/// in at u > 0 [m/s] has gained on its way from rest; none where it goes out. It never turns the
/// flow: in steps in which fluid comes in by more than a cell it is less.
double loss_of_inflow(const FaceProperties& face, double inwards, double spacing, double dt) {
  if (inwards <= 0)
    return 0;
  return -0.5 * face.distance_factor * inwards * std::min(dt * inwards / spacing, 1.0);
}
}  // namespace

template <int dim>
Momentum<dim> push_of_pressures(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                double time, double dt, FaceField<dim>& velocity) {
  Momentum<dim> mine;
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
      const double change =
          inward * (dt * face.gradient * pressure +
                    loss_of_inflow(face, inward * velocity[axis][cell], domain.spacing(), dt));
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
      const double length = 2 * M_PI / side.wave->number;
      notes.emplace_back("inflow " + side_name(axis, end),
                         fmt::format("waves {:.6g} m long ({:.3g} cells), {:.6g} m/s fast", length,
                                     length / domain.spacing(), side.wave->speed()));
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

template Momentum<2> push_of_pressures<2>(const MacDomain<2>&, const MacGeometry<2>&, double,
                                          double, FaceField<2>&);
template Momentum<3> push_of_pressures<3>(const MacDomain<3>&, const MacGeometry<3>&, double,
                                          double, FaceField<3>&);
template std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<2>&, const MacGeometry<2>&,
                                                     double);
template std::vector<PrescribedFlux> fluxes_of_sides(const MacDomain<3>&, const MacGeometry<3>&,
                                                     double);
template std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<2>&,
                                                                           const MacGeometry<2>&);
template std::vector<std::pair<std::string, std::string>> notes_of_inflows(const MacDomain<3>&,
                                                                           const MacGeometry<3>&);

}  // namespace lockstep
