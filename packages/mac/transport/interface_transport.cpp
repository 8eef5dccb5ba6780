#include "mac/transport/interface_transport.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {
/// Distance from the interface, beside what it moves over, within which faces are advected here,
/// and of those more that only serve them [cells].
constexpr double reach = 2, margin = 2;
/// Largest sum over the axes of the displacement in a part of a step [cells].
constexpr double largest_part = 0.5;
/// Ratio of densities from which on a face is much denser than another one: that of a face which
/// the interface only passes through gains less in a step.
constexpr double much_denser = 4;

double minmod(double a, double b) {
  return a * b <= 0 ? 0 : std::abs(a) < std::abs(b) ? a : b;
}
}  // namespace

template <int dim>
InterfaceTransport<dim>::InterfaceTransport(const MacDomain<dim>& domain,
                                            const MacGeometry<dim>& geometry,
                                            const CellField& distance,
                                            const FaceField<dim>& advection, double dt)
    : domain_(domain), geometry_(geometry), advection_(advection), dt_(dt) {
  double sum = 0;
  for (int axis = 0; axis < dim; ++axis) {
    domain.full_halo.fill(advection_[axis]);
    double fastest = 0;
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (has_velocity(axis, cell))
        fastest = std::max(fastest, std::abs(advection[axis][cell]));
    });
    sum += max_all(domain.grid.comm(), fastest);
  }
  const double displacement = sum * dt / domain.spacing();
  check_solve(displacement < 1e6,
              "Advection near the interface: the velocity is not finite or carries the fluid over "
              "more than a million cells in one step of {} s; the run has become unstable: shorten "
              "the time step.",
              dt);
  n_parts_ = std::max(1, static_cast<int>(std::ceil(displacement / largest_part)));
  find_faces(distance, displacement);
}

template <int dim>
bool InterfaceTransport<dim>::is_regular(int axis, int cell) const {
  const FaceCells cells = cells_of_face(domain_.grid, geometry_.state.cells, axis, cell);
  return geometry_.state.faces[axis][cell] == FaceState::free && !cells.at_side() &&
         !geometry_.near_surface(cells.lower) && !geometry_.near_surface(cells.upper);
}

template <int dim>
void InterfaceTransport<dim>::find_faces(const CellField& distance, double displacement) {
  const double h = domain_.spacing();
  const double taken = (reach + displacement) * h, near = taken + margin * h;
  for (int axis = 0; axis < dim; ++axis)
    domain_.grid.for_each_owned_face(axis, [&](int cell) {
      const int lower = domain_.grid.neighbor(cell, axis, 0);
      if (lower < 0)
        return;
      const double from_interface = std::min(std::abs(distance[cell]), std::abs(distance[lower]));
      if (from_interface >= near || geometry_.state.faces[axis][cell] == FaceState::inactive)
        return;
      if (is_regular(axis, cell))
        faces_.push_back({axis, cell, from_interface < taken});
      else
        beside_solids_.push_back({axis, cell, geometry_.face_table(axis, cell).density});
    });
}

template <int dim>
double InterfaceTransport<dim>::speed_through(const Face& face, int across, int end) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const auto speed = [&](int of) { return has_velocity(across, of) ? advection_[across][of] : 0; };
  if (across == face.axis)
    return 0.5 * (advection_[across][face.cell] + speed(grid.neighbor(face.cell, across, end)));
  const int below = grid.neighbor(face.cell, face.axis, 0);
  return end == 0 ? 0.5 * (speed(face.cell) + speed(below))
                  : 0.5 * (speed(grid.neighbor(face.cell, across, 1)) +
                           speed(grid.neighbor(below, across, 1)));
}

template <int dim>
void InterfaceTransport<dim>::add_flux(const Fields& fields, const Face& face, int across, int end,
                                       Change& change) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const int axis = face.axis, own = face.cell;
  const double outwards = (end == 0 ? -1 : 1) * speed_through(face, across, end);
  int other = grid.neighbor(own, across, end);
  if (!has_velocity(axis, other))
    other = own;
  const int from = outwards >= 0 ? own : other, to = outwards >= 0 ? other : own;
  const int before = grid.neighbor(from, across, outwards >= 0 ? 1 - end : end);
  const CellField& u = fields.velocity[axis];
  double velocity = u[from];
  if (has_velocity(axis, before))
    velocity += 0.5 * minmod(u[to] - u[from], u[from] - u[before]);
  const double mass = outwards * fields.density[axis][from] * dt_ / (n_parts_ * domain_.spacing());
  change.mass -= mass;
  change.momentum -= mass * velocity;
  if (mass < 0 &&
      fields.density[axis][from] > much_denser * geometry_.face_table(axis, own).density) {
    change.mass_of_denser -= mass;
    change.momentum_of_denser -= mass * velocity;
  }
}

template <int dim>
std::vector<CarriedMass> InterfaceTransport<dim>::advect(const FaceField<dim>& velocity,
                                                         FaceField<dim>& result) const {
  Fields fields{velocity, velocity};
  for (int axis = 0; axis < dim; ++axis) {
    for (std::size_t cell = 0; cell < velocity[axis].size(); ++cell)
      fields.density[axis][cell] = geometry_.face_table(axis, static_cast<int>(cell)).density;
    domain_.full_halo.fill(fields.velocity[axis]);
  }
  std::vector<Change> changes(faces_.size()), sums(faces_.size());
  for (int part = 0; part < n_parts_; ++part) {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      changes[i] = {};
      for (int across = 0; across < dim; ++across)
        for (int end = 0; end < 2; ++end)
          add_flux(fields, faces_[i], across, end, changes[i]);
    }
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const auto [axis, cell, is_taken] = faces_[i];
      double& density = fields.density[axis][cell];
      double& u = fields.velocity[axis][cell];
      const double after = density + changes[i].mass;
      u = (density * u + changes[i].momentum) / after;
      density = after;
      sums[i].mass_of_denser += changes[i].mass_of_denser;
      sums[i].momentum_of_denser += changes[i].momentum_of_denser;
    }
    for (int axis = 0; axis < dim && part + 1 < n_parts_; ++axis) {
      domain_.full_halo.fill(fields.density[axis]);
      domain_.full_halo.fill(fields.velocity[axis]);
    }
  }
  std::vector<CarriedMass> carried = beside_solids_;
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const auto [axis, cell, is_taken] = faces_[i];
    if (!is_taken)
      continue;
    result[axis][cell] = fields.velocity[axis][cell];
    const double mass = sums[i].mass_of_denser;
    carried.push_back({axis, cell, fields.density[axis][cell], mass,
                       mass > 0 ? sums[i].momentum_of_denser / mass : 0});
  }
  return carried;
}

template <int dim>
void correct_flooded(const MacGeometry<dim>& geometry, const std::vector<CarriedMass>& carried,
                     FaceField<dim>& velocity, InvalidSamples<dim>& invalid) {
  // Less liquid than this has a velocity of round-off [of the face's density].
  constexpr double least = 1e-6;
  for (const CarriedMass& face : carried) {
    const double density = geometry.face_table(face.axis, face.cell).density;
    if (density <= much_denser * face.density)
      continue;
    if (face.from_denser > least * density) {
      velocity[face.axis][face.cell] = face.velocity_of_denser;
      continue;
    }
    std::vector<char>& faces = invalid.faces[face.axis];
    if (faces.empty())
      faces.resize(geometry.state.faces[face.axis].size());
    faces[face.cell] = 1;
  }
}

template class InterfaceTransport<2>;
template class InterfaceTransport<3>;
template void correct_flooded<2>(const MacGeometry<2>&, const std::vector<CarriedMass>&,
                                 FaceField<2>&, InvalidSamples<2>&);
template void correct_flooded<3>(const MacGeometry<3>&, const std::vector<CarriedMass>&,
                                 FaceField<3>&, InvalidSamples<3>&);

}  // namespace lockstep
