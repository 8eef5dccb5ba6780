#include "mac/parts/mac_audit.hpp"

#include "mac/parts/mac_drops.hpp"
#include "mac/pressure/pressure_system.hpp"
#include "staggered/state/face_moments.hpp"

namespace lockstep {

template <int dim>
AngularVector<dim> moment_of_shifts(const MacGeometry<dim>& geometry,
                                    const std::function<double(int axis, int cell)>& velocity) {
  AngularVector<dim> moment = AngularVector<dim>::Zero();
  for (std::size_t i = 0; i < geometry.coupled.size(); ++i) {
    const ControlVolume<dim>& volume = geometry.coupled_volumes[i];
    if (volume.open_fraction == 0)
      continue;
    const auto [axis, cell] = geometry.coupled[i];
    const double momentum = geometry.mass(axis, cell) * velocity(axis, cell);
    moment += cross<dim>(volume.open_center - volume.center, Point<dim>::Unit(axis) * momentum);
  }
  return moment;
}

template <int dim>
Momentum<dim> MacAudit<dim>::momentum() const {
  Momentum<dim> mine;
  const double regular = flow_.geometry.face_table.regular().mass;
  for (int axis = 0; axis < dim; ++axis) {
    FaceMoments<dim> moments(flow_.domain.grid, axis);
    const double* u = flow_.prediction[axis].data();
    flow_.domain.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && flow_.geometry.has_regular_faces(axis, first)) {
        moments.add_row(first, regular * row_of<dim>(u, first));
        return;
      }
      for (int face = first; face < first + n; ++face)
        if (const double mass = flow_.geometry.mass(axis, face); mass > 0)
          moments.add(face, mass * u[face]);
    });
    mine += moments.total();
  }
  mine.angular += moment_of_shifts<dim>(
      flow_.geometry, [&](int axis, int cell) { return flow_.prediction[axis][cell]; });
  if (flow_.has_drops())
    mine += momentum_of_drops(flow_);
  return sum_over_ranks(mine, flow_.domain.grid.comm());
}

template <int dim>
double MacAudit<dim>::kinetic_energy() const {
  double mine = 0;
  StripValues<dim> squares = StripValues<dim>::Zero();
  for (int axis = 0; axis < dim; ++axis) {
    const double* u = flow_.prediction[axis].data();
    flow_.domain.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && flow_.geometry.has_regular_faces(axis, first)) {
        squares += row_of<dim>(u, first).square();
        return;
      }
      for (int face = first; face < first + n; ++face)
        mine += flow_.geometry.mass(axis, face) * u[face] * u[face];
    });
  }
  mine += flow_.geometry.face_table.regular().mass * squares.sum();
  if (flow_.has_drops())
    mine += 2 * energy_of_drops(flow_);
  return 0.5 * sum_all(flow_.domain.grid.comm(), mine);
}

template <int dim>
Momentum<dim> MacAudit<dim>::boundary_pressure_impulse(const Vector& scaled_pressure) const {
  return side_pressure_impulse(flow_.domain, flow_.geometry, scaled_pressure);
}

template <int dim>
std::vector<double> MacEnergy<dim>::works() {
  std::vector<double> all(stages_.size() - 1, 0.0);
  const FaceField<dim>&first = stages_.front(), &last = stages_.back();
  for (int axis = 0; axis < dim; ++axis)
    flow_.domain.grid.for_each_owned_face(axis, [&](int face) {
      const double momentum =
          0.5 * flow_.geometry.mass(axis, face) * (first[axis][face] + last[axis][face]);
      for (std::size_t k = 0; k < all.size(); ++k)
        all[k] += momentum * (stages_[k + 1][axis][face] - stages_[k][axis][face]);
    });
  sum_over_ranks(flow_.domain.grid.comm(), all);
  stages_.clear();
  return all;
}

template AngularVector<2> moment_of_shifts(const MacGeometry<2>&,
                                           const std::function<double(int, int)>&);
template AngularVector<3> moment_of_shifts(const MacGeometry<3>&,
                                           const std::function<double(int, int)>&);
template class MacAudit<2>;
template class MacAudit<3>;
template class MacEnergy<2>;
template class MacEnergy<3>;

}  // namespace lockstep
