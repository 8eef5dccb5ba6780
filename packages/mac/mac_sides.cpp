// Fluxes through the sides of the domain.
#include <cmath>

#include "base/errors.hpp"
#include "mac/mac_fluid.hpp"

namespace lockstep {

namespace {

/// Calls f(axis, end, side) for the sides that fluid enters or leaves through at a given velocity.
template <int dim, typename Function>
void for_each_inflow(const Boundary<dim>& boundary, const Function& f) {
  for (int axis = 0; axis < dim; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const BoundarySide<dim>& side = boundary.side(axis, end);
      if (side.type == SideType::inflow && (side.wave || side.velocity[axis] != 0))
        f(axis, end, side);
    }
  }
}

}  // namespace

template <int dim>
void MacFluid<dim>::set_prescribed(double time, FaceField<dim>& velocity) const {
  for (const auto& [axis, cell] : geometry_.prescribed) {
    const int end = geometry_.state.cells[cell] == CellState::outside ? 1 : 0;
    const Box<dim> face = domain_.face_box(axis, cell);
    velocity[axis][cell] = domain_.boundary.side(axis, end).mean_velocity(axis, face, time)[axis];
  }
  domain_.halo.fill(velocity);
}

template <int dim>
std::vector<PrescribedFlux> MacFluid<dim>::side_fluxes(double time) const {
  std::vector<PrescribedFlux> fluxes;
  for_each_inflow(domain_.boundary, [&](int axis, int end, const BoundarySide<dim>& side) {
    fluxes.push_back({fmt::format("the inflow \"{}\"", side_name(axis, end)), {}});
    for (const auto& [face_axis, cell] : geometry_.prescribed) {
      const bool is_upper = geometry_.state.cells[cell] == CellState::outside;
      if (face_axis != axis || is_upper != (end == 1))
        continue;
      const double velocity =
          side.mean_velocity(axis, domain_.face_box(axis, cell), time)[axis] * (is_upper ? -1 : 1);
      const int fluid = is_upper ? domain_.grid.neighbor(cell, axis, 0) : cell;
      const double area = geometry_.face_table.area() * geometry_.flux_fraction(axis, cell);
      if (velocity != 0)
        fluxes.back().into.emplace_back(geometry_.unknown[fluid], area * velocity);
    }
  });
  return fluxes;
}

template <int dim>
std::vector<std::pair<std::string, std::string>> MacFluid<dim>::notes() const {
  std::vector<std::pair<std::string, std::string>> notes;
  if (moving_tiles_) {
    GlobalIndex n_tiles = 1;
    for (const int n : domain_.grid.tile_lattice().n_domain_tiles())
      n_tiles *= n;
    notes.emplace_back("moving tiles",
                       fmt::format("{} of {} at the start", owners_.tiles.size(), n_tiles));
  }
  for_each_inflow(domain_.boundary, [&](int axis, int end, const BoundarySide<dim>& side) {
    if (side.wave) {
      const double length = 2 * M_PI / side.wave->number;
      notes.emplace_back("inflow " + side_name(axis, end),
                         fmt::format("waves {:.6g} m long ({:.3g} cells), {:.6g} m/s fast", length,
                                     length / domain_.spacing(), side.wave->speed()));
      return;
    }
    double sums[3] = {0, 0, 0};  // open area, faces, faces in part
    InflowShape<dim> opening = side.shape;
    opening.parabolic = false;
    for (const auto& [face_axis, cell] : geometry_.prescribed) {
      const bool is_upper = geometry_.state.cells[cell] == CellState::outside;
      if (face_axis != axis || is_upper != (end == 1))
        continue;
      const double open = opening.mean_factor(axis, domain_.face_box(axis, cell));
      sums[0] += open * geometry_.face_table.area();
      sums[1] += open > 0;
      sums[2] += open > 0 && open < 1;
    }
    sum_all(domain_.grid.comm(), sums, 3);
    notes.emplace_back(
        "inflow " + side_name(axis, end),
        fmt::format("{:.6g} m^{}/s through {:.6g} m^{}: {:.0f} faces, {:.0f} of them in part",
                    std::abs(side.velocity[axis]) * sums[0], dim, sums[0], dim - 1, sums[1],
                    sums[2]));
  });
  return notes;
}

template <int dim>
Box<dim> MacFluid<dim>::bounds() const {
  return domain_.bounds();
}

template <int dim>
std::array<std::array<bool, 2>, dim> MacFluid<dim>::closed_sides() const {
  std::array<std::array<bool, 2>, dim> closed{};
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      closed[axis][end] = domain_.boundary.side(axis, end).closed();
  return closed;
}

template <int dim>
Point<dim> MacFluid<dim>::wall_velocity(int axis, int end, double time) const {
  const BoundarySide<dim>& side = domain_.boundary.side(axis, end);
  return side.closed() ? side.velocity_at(axis, bounds().min(), time) : Point<dim>::Zero();
}

template <int dim>
bool MacFluid<dim>::is_periodic() const {
  bool any = false;
  for (int axis = 0; axis < dim; ++axis)
    any = any || domain_.boundary.periodic(axis);
  return any;
}

template Box<2> MacFluid<2>::bounds() const;
template Box<3> MacFluid<3>::bounds() const;
template std::array<std::array<bool, 2>, 2> MacFluid<2>::closed_sides() const;
template std::array<std::array<bool, 2>, 3> MacFluid<3>::closed_sides() const;
template Point<2> MacFluid<2>::wall_velocity(int, int, double) const;
template Point<3> MacFluid<3>::wall_velocity(int, int, double) const;
template bool MacFluid<2>::is_periodic() const;
template bool MacFluid<3>::is_periodic() const;
template void MacFluid<2>::set_prescribed(double, FaceField<2>&) const;
template void MacFluid<3>::set_prescribed(double, FaceField<3>&) const;
template std::vector<PrescribedFlux> MacFluid<2>::side_fluxes(double) const;
template std::vector<PrescribedFlux> MacFluid<3>::side_fluxes(double) const;
template std::vector<std::pair<std::string, std::string>> MacFluid<2>::notes() const;
template std::vector<std::pair<std::string, std::string>> MacFluid<3>::notes() const;

}  // namespace lockstep
