#include "mac/parts/mac_drops.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "output/frames.hpp"

namespace lockstep {

template <int dim>
Momentum<dim> momentum_of_drops(const MacFlow<dim>& flow) {
  Momentum<dim> mine = flow.liquid->drops()->momentum();
  mine.linear *= flow.parameters.density;
  mine.angular *= flow.parameters.density;
  return mine;
}

template <int dim>
double energy_of_drops(const MacFlow<dim>& flow) {
  return flow.parameters.density * flow.liquid->drops()->kinetic_energy();
}

template <int dim>
Momentum<dim> speed_up_drops(MacFlow<dim>& flow) {
  Momentum<dim> mine = flow.liquid->drops()->speed_up();
  mine.linear *= flow.parameters.density;
  mine.angular *= flow.parameters.density;
  return mine;
}

/// The faces around their cell gain what the drops have beyond the fluid there, m (v - u). Their
/// mass m follows with the next correction of the volume, spread over the body's surface at
/// velocities of the fluid, so that both together bring what the drops had.
template <int dim>
void give_back_momentum(MacFlow<dim>& flow) {
  const TiledGrid<dim>& grid = flow.domain.grid;
  const std::vector<Drop<dim>>& fallen = flow.liquid->drops()->fallen();
  if (max_all(grid.comm(), static_cast<GlobalIndex>(fallen.size())) == 0)
    return;
  struct Fallen {
    double mass = 0;
    Point<dim> momentum = Point<dim>::Zero();
  };
  std::map<int, Fallen> by_cell;
  for (const Drop<dim>& drop : fallen) {
    const double mass = flow.parameters.density * drop.volume;
    Fallen& in_cell = by_cell[grid.cell_containing(drop.position)];
    in_cell.mass += mass;
    in_cell.momentum += mass * drop.velocity;
  }
  // The momentum of coupled faces is lumped with the solids.
  const auto is_free = [&](int axis, int face) {
    return face >= 0 && flow.geometry.state.faces[axis][face] == FaceState::free;
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
          mass += flow.geometry.mass(axis, face);
          momentum += flow.geometry.mass(axis, face) * flow.prediction[axis][face];
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
  flow.domain.halo.sum_to_owner(change);
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis,
                             [&](int face) { flow.prediction[axis][face] += change[axis][face]; });
  flow.domain.halo.fill(flow.prediction);
}

template <int dim>
std::vector<SurfaceImpulse<dim>> impulses_of_drops(const MacFlow<dim>& flow) {
  if (!flow.has_drops())
    return {};
  std::vector<double> numbers;
  for (const SurfaceImpulse<dim>& push : flow.liquid->drops()->pushes()) {
    numbers.push_back(push.point.simplex);
    for (const auto& part : {push.point.barycentric, push.place, push.impulse})
      numbers.insert(numbers.end(), part.begin(), part.end());
  }
  numbers = gather_all(flow.domain.grid.comm(), numbers);
  std::vector<SurfaceImpulse<dim>> all(numbers.size() / (1 + 3 * dim));
  auto number = numbers.cbegin();
  for (SurfaceImpulse<dim>& push : all) {
    push.point.simplex = static_cast<int>(*number++);
    for (auto* part : {&push.point.barycentric, &push.place, &push.impulse})
      for (double& component : *part)
        component = *number++;
    push.point.position = push.place;
    push.impulse *= flow.parameters.density;
  }
  return all;
}

template <int dim>
SurfaceFrame frame_of_drops(const MacFlow<dim>& flow) {
  std::vector<double> mine;
  for (const Drop<dim>& drop : flow.liquid->drops()->mine()) {
    mine.insert(mine.end(), drop.position.begin(), drop.position.end());
    mine.insert(mine.end(), drop.velocity.begin(), drop.velocity.end());
    mine.push_back(dim == 2 ? std::sqrt(drop.volume / M_PI)
                            : std::cbrt(drop.volume * 3 / (4 * M_PI)));
  }
  const std::vector<double> all = gather_all(flow.domain.grid.comm(), mine);
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

template Momentum<2> momentum_of_drops(const MacFlow<2>&);
template Momentum<3> momentum_of_drops(const MacFlow<3>&);
template double energy_of_drops(const MacFlow<2>&);
template double energy_of_drops(const MacFlow<3>&);
template Momentum<2> speed_up_drops(MacFlow<2>&);
template Momentum<3> speed_up_drops(MacFlow<3>&);
template void give_back_momentum(MacFlow<2>&);
template void give_back_momentum(MacFlow<3>&);
template std::vector<SurfaceImpulse<2>> impulses_of_drops(const MacFlow<2>&);
template std::vector<SurfaceImpulse<3>> impulses_of_drops(const MacFlow<3>&);
template SurfaceFrame frame_of_drops(const MacFlow<2>&);
template SurfaceFrame frame_of_drops(const MacFlow<3>&);

}  // namespace lockstep
