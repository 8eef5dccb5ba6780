#pragma once
#include <vector>

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
  template <typename F>
  void for_each_part(const F& f) {
    f(linear);
    f(angular);
  }
  friend Momentum operator+(Momentum a, const Momentum& b) { return a += b; }
  friend Momentum operator-(Momentum a, const Momentum& b) { return a -= b; }
};

/// Sums each momentum over all ranks, on every rank. Collective.
template <int dim>
void sum_over_ranks(std::vector<Momentum<dim>>& momenta, const Communicator& comm) {
  sum_over_ranks(comm, momenta);
}

/// Sums one momentum over all ranks. Collective.
template <int dim>
Momentum<dim> sum_over_ranks(Momentum<dim> mine, const Communicator& comm) {
  sum_over_ranks(comm, mine);
  return mine;
}

/// Adds one by one: as many as there are in `sums`.
template <int dim>
void add_each(const std::vector<Momentum<dim>>& momenta, std::vector<Momentum<dim>>& sums) {
  for (std::size_t s = 0; s < sums.size(); ++s)
    sums[s] += momenta[s];
}

template <int dim>
Momentum<dim> total_of(const std::vector<Momentum<dim>>& momenta) {
  Momentum<dim> total;
  for (const Momentum<dim>& momentum : momenta)
    total += momentum;
  return total;
}

}  // namespace lockstep
