#pragma once
#include "base/communicator.hpp"
#include "base/types.hpp"

namespace lockstep {

/// Linear momentum or impulse [kg m/s] and angular momentum or impulse about the origin [kg m^2/s].
template <int dim>
struct Momentum {
  Point<dim> linear = Point<dim>::Zero();
  AngularVector<dim> angular = AngularVector<dim>::Zero();

  /// Adds an impulse that acts at x.
  void add(const Point<dim>& x, const Point<dim>& impulse) {
    linear += impulse;
    angular += cross<dim>(x, impulse);
  }
  /// Adds an impulse along one axis that acts at x.
  void add(const Point<dim>& x, int axis, double impulse) {
    add(x, Point<dim>::Unit(axis) * impulse);
  }
  Momentum& operator+=(const Momentum& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
  Momentum& operator-=(const Momentum& other) {
    linear -= other.linear;
    angular -= other.angular;
    return *this;
  }
  friend Momentum operator+(Momentum a, const Momentum& b) { return a += b; }
  friend Momentum operator-(Momentum a, const Momentum& b) { return a -= b; }
};

/// Sum over all ranks, on every rank. Collective.
template <int dim>
Momentum<dim> sum_over_ranks(const Momentum<dim>& mine, const Communicator& comm) {
  std::array<double, dim + n_rotations<dim>> values;
  for (int a = 0; a < dim; ++a)
    values[a] = mine.linear[a];
  for (int r = 0; r < n_rotations<dim>; ++r)
    values[dim + r] = mine.angular[r];
  sum_all(comm, values.data(), static_cast<int>(values.size()));
  Momentum<dim> total;
  for (int a = 0; a < dim; ++a)
    total.linear[a] = values[a];
  for (int r = 0; r < n_rotations<dim>; ++r)
    total.angular[r] = values[dim + r];
  return total;
}

}  // namespace lockstep
