// Drops that the grid of a fluid does not resolve.
#include <algorithm>
#include <cmath>
#include <map>

#include "mac/mac_fluid.hpp"
#include "output/frames.hpp"

namespace lockstep {

template <int dim>
Momentum<dim> MacFluid<dim>::momentum_of_drops() const {
  Momentum<dim> mine = liquid_->drops()->momentum();
  mine.linear *= parameters_.density;
  mine.angular *= parameters_.density;
  return mine;
}

template <int dim>
double MacFluid<dim>::energy_of_drops() const {
  return parameters_.density * liquid_->drops()->kinetic_energy();
}

template <int dim>
Momentum<dim> MacFluid<dim>::speed_up_drops() {
  Momentum<dim> mine = liquid_->drops()->speed_up();
  mine.linear *= parameters_.density;
  mine.angular *= parameters_.density;
  return mine;
}

/// The faces around their cell gain what the drops have beyond the fluid there, m (v - u). Their
/// mass m follows with the next correction of the volume, spread over the body's surface at
/// velocities of the fluid, so that both together bring what the drops had.
template <int dim>
void MacFluid<dim>::give_back_momentum() {
  const TiledGrid<dim>& grid = domain_.grid;
  const std::vector<Drop<dim>>& fallen = liquid_->drops()->fallen();
  if (max_all(grid.comm(), static_cast<GlobalIndex>(fallen.size())) == 0)
    return;
  struct Fallen {
    double mass = 0;
    Point<dim> momentum = Point<dim>::Zero();
  };
  std::map<int, Fallen> by_cell;
  for (const Drop<dim>& drop : fallen) {
    const double mass = parameters_.density * drop.volume;
    Fallen& in_cell = by_cell[grid.cell_containing(drop.position)];
    in_cell.mass += mass;
    in_cell.momentum += mass * drop.velocity;
  }
  // The momentum of coupled faces is lumped with the solids.
  const auto is_free = [&](int axis, int face) {
    return face >= 0 && geometry_.state.faces[axis][face] == FaceState::free;
  };
  FaceField<dim> change;
  for (CellField& component : change)
    component.assign(grid.n_stored_cells(), 0);
  for (const auto& [cell, in_cell] : by_cell)
    for (int axis = 0; axis < dim; ++axis) {
      double mass = 0, momentum = 0;
      const std::array<int, 2> faces{cell, grid.neighbor(cell, axis, 1)};
      for (const int face : faces)
        if (is_free(axis, face)) {
          mass += geometry_.mass(axis, face);
          momentum += geometry_.mass(axis, face) * prediction_[axis][face];
        }
      if (mass == 0)
        continue;
      const double beyond = in_cell.momentum[axis] / in_cell.mass - momentum / mass;
      // Drops heavier than the fluid there take it along, no faster than they are.
      const double gained = beyond * std::min(1., in_cell.mass / mass);
      for (const int face : faces)
        if (is_free(axis, face))
          change[axis][face] += gained;
    }
  domain_.halo.sum_to_owner(change);
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis,
                             [&](int face) { prediction_[axis][face] += change[axis][face]; });
  domain_.halo.fill(prediction_);
}

template <int dim>
std::vector<SurfaceImpulse<dim>> MacFluid<dim>::impulses_on_solids() const {
  if (!has_drops())
    return {};
  std::vector<double> numbers;
  for (const SurfaceImpulse<dim>& push : liquid_->drops()->pushes()) {
    numbers.push_back(push.point.simplex);
    for (const auto& part : {push.point.barycentric, push.place, push.impulse})
      numbers.insert(numbers.end(), part.begin(), part.end());
  }
  numbers = gather_all(domain_.grid.comm(), numbers);
  std::vector<SurfaceImpulse<dim>> all(numbers.size() / (1 + 3 * dim));
  auto number = numbers.cbegin();
  for (SurfaceImpulse<dim>& push : all) {
    push.point.simplex = static_cast<int>(*number++);
    for (auto* part : {&push.point.barycentric, &push.place, &push.impulse})
      for (double& component : *part)
        component = *number++;
    push.point.position = push.place;
    push.impulse *= parameters_.density;
  }
  return all;
}

/// Points with radii and velocities.
template <int dim>
SurfaceFrame MacFluid<dim>::frame_of_drops() const {
  std::vector<double> mine;
  for (const Drop<dim>& drop : liquid_->drops()->mine()) {
    mine.insert(mine.end(), drop.position.begin(), drop.position.end());
    mine.insert(mine.end(), drop.velocity.begin(), drop.velocity.end());
    mine.push_back(dim == 2 ? std::sqrt(drop.volume / M_PI)
                            : std::cbrt(drop.volume * 3 / (4 * M_PI)));
  }
  const std::vector<double> all = gather_all(domain_.grid.comm(), mine);
  SurfaceFrame frame;
  frame.name = "drops";
  frame.dimension = dim;
  frame.simplex_size = 1;
  SurfaceField velocity{"velocity", "m/s", dim, SurfaceField::Place::vertices, {}};
  SurfaceField radius{"radius", "m", 1, SurfaceField::Place::vertices, {}};
  for (auto number = all.cbegin(); number != all.cend();) {
    frame.simplices.push_back(static_cast<int>(frame.simplices.size()));
    frame.vertices.insert(frame.vertices.end(), number, number + dim);
    velocity.values.insert(velocity.values.end(), number + dim, number + 2 * dim);
    radius.values.push_back(number[2 * dim]);
    number += 2 * dim + 1;
  }
  frame.fields = {std::move(velocity), std::move(radius)};
  return frame;
}

template Momentum<2> MacFluid<2>::momentum_of_drops() const;
template Momentum<3> MacFluid<3>::momentum_of_drops() const;
template double MacFluid<2>::energy_of_drops() const;
template double MacFluid<3>::energy_of_drops() const;
template Momentum<2> MacFluid<2>::speed_up_drops();
template Momentum<3> MacFluid<3>::speed_up_drops();
template void MacFluid<2>::give_back_momentum();
template void MacFluid<3>::give_back_momentum();
template std::vector<SurfaceImpulse<2>> MacFluid<2>::impulses_on_solids() const;
template std::vector<SurfaceImpulse<3>> MacFluid<3>::impulses_on_solids() const;
template SurfaceFrame MacFluid<2>::frame_of_drops() const;
template SurfaceFrame MacFluid<3>::frame_of_drops() const;

}  // namespace lockstep
