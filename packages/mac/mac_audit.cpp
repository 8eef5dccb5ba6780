// What MacFluid says about all of its fluid at once.
#include <algorithm>
#include <cmath>

#include "mac/mac_fluid.hpp"
#include "staggered/state/face_moments.hpp"

namespace lockstep {

template <int dim>
AngularVector<dim> MacFluid<dim>::moment_of_shifts(const FaceFunction& velocity) const {
  AngularVector<dim> moment = AngularVector<dim>::Zero();
  for (std::size_t i = 0; i < geometry_.coupled.size(); ++i) {
    const ControlVolume<dim>& volume = geometry_.coupled_volumes[i];
    if (volume.open_fraction == 0)
      continue;
    const auto [axis, cell] = geometry_.coupled[i];
    const double momentum = geometry_.mass(axis, cell) * velocity(axis, cell);
    moment += cross<dim>(volume.open_center - volume.center, Point<dim>::Unit(axis) * momentum);
  }
  return moment;
}

template <int dim>
Momentum<dim> MacFluid<dim>::momentum() const {
  Momentum<dim> mine;
  const double regular = geometry_.face_table.regular().mass;
  for (int axis = 0; axis < dim; ++axis) {
    FaceMoments<dim> moments(domain_.grid, axis);
    const double* u = prediction_[axis].data();
    domain_.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && geometry_.has_regular_faces(axis, first)) {
        moments.add_row(first, regular * row_of<dim>(u, first));
        return;
      }
      for (int face = first; face < first + n; ++face)
        if (const double mass = geometry_.mass(axis, face); mass > 0)
          moments.add(face, mass * u[face]);
    });
    mine += moments.total();
  }
  mine.angular += moment_of_shifts([&](int axis, int cell) { return prediction_[axis][cell]; });
  if (has_drops())
    mine += momentum_of_drops();
  return sum_over_ranks(mine, domain_.grid.comm());
}

template <int dim>
double MacFluid<dim>::kinetic_energy() const {
  double mine = 0;
  RowValues<dim> squares = RowValues<dim>::Zero();
  for (int axis = 0; axis < dim; ++axis) {
    const double* u = prediction_[axis].data();
    domain_.grid.for_each_owned_face_row(axis, [&](int first, int n, int) {
      if (n == tile_width<dim> && geometry_.has_regular_faces(axis, first)) {
        squares += row_of<dim>(u, first).square();
        return;
      }
      for (int face = first; face < first + n; ++face)
        mine += geometry_.mass(axis, face) * u[face] * u[face];
    });
  }
  mine += geometry_.face_table.regular().mass * squares.sum();
  if (has_drops())
    mine += 2 * energy_of_drops();
  return 0.5 * sum_all(domain_.grid.comm(), mine);
}

template <int dim>
std::vector<double> MacFluid<dim>::works() {
  std::vector<double> all(stages_.size() - 1, 0.0);
  const FaceField<dim>&first = stages_.front(), &last = stages_.back();
  for (int axis = 0; axis < dim; ++axis)
    domain_.grid.for_each_owned_face(axis, [&](int face) {
      const double momentum =
          0.5 * geometry_.mass(axis, face) * (first[axis][face] + last[axis][face]);
      for (std::size_t k = 0; k < all.size(); ++k)
        all[k] += momentum * (stages_[k + 1][axis][face] - stages_[k][axis][face]);
    });
  sum_all(domain_.grid.comm(), all.data(), static_cast<int>(all.size()));
  stages_.clear();
  return all;
}

template <int dim>
double MacFluid<dim>::largest_speed() const {
  if (largest_speed_)
    return *largest_speed_;
  double largest = 0;
  const auto speed = [&](int axis, int face) {
    const bool still = face < 0 || geometry_.state.faces[axis][face] == FaceState::inactive;
    return still ? 0.0 : std::abs(velocity_[axis][face]);
  };
  const auto look_at_cell = [&](int cell, const auto& neighbors) {
    if (geometry_.state.cells[cell] != CellState::fluid)
      return;
    double sum = 0;
    for (int axis = 0; axis < dim; ++axis)
      sum += std::max(speed(axis, cell), speed(axis, neighbors[2 * axis + 1]));
    largest = std::max(largest, sum);
  };
  RowValues<dim> largest_in_rows = RowValues<dim>::Zero();
  domain_.grid.for_each_owned_row([&](const CellRow<dim>& row) {
    if (!geometry_.has_regular_faces(row)) {
      row.for_each_cell(look_at_cell);
      return;
    }
    const RowValues<dim> along = row_of<dim>(velocity_[0].data(), row.begin).abs();
    RowValues<dim> sum = along.max(row_ahead<dim>(along, speed(0, row.neighbors[1])));
    for (int axis = 1; axis < dim; ++axis) {
      const double* u = velocity_[axis].data();
      sum += row_of<dim>(u, row.begin).abs().max(row_of<dim>(u, row.neighbors[2 * axis + 1]).abs());
    }
    largest_in_rows = largest_in_rows.max(sum);
  });
  largest = std::max(largest, largest_in_rows.maxCoeff());
  largest_speed_ = max_all(domain_.grid.comm(), largest);
  return *largest_speed_;
}

template AngularVector<2> MacFluid<2>::moment_of_shifts(const FaceFunction&) const;
template Momentum<2> MacFluid<2>::momentum() const;
template double MacFluid<2>::kinetic_energy() const;
template std::vector<double> MacFluid<2>::works();
template double MacFluid<2>::largest_speed() const;
template AngularVector<3> MacFluid<3>::moment_of_shifts(const FaceFunction&) const;
template Momentum<3> MacFluid<3>::momentum() const;
template double MacFluid<3>::kinetic_energy() const;
template std::vector<double> MacFluid<3>::works();
template double MacFluid<3>::largest_speed() const;

}  // namespace lockstep
