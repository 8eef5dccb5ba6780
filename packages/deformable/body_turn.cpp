#include "deformable/body_turn.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace lockstep {

template <int dim>
void BodyTurn<dim>::begin(double dt, const std::vector<char>& is_free) {
  constexpr double least = 1e-5;  // turn in a step [rad]: strains by its square are round-off
  dt_ = dt;
  turns_.assign(states_.size(), {});
  bool any = false;
  for (std::size_t b = 0; b < states_.size(); ++b) {
    const SoftBody& body = nodes_.bodies[b];
    const AngularVector<dim>& rate = states_[b].angular_velocity;
    Turn& turn = turns_[b];
    turn.is_turning = is_free[b] != 0 && body.closed && body.mass > 0 && body.is_second_order() &&
                      rate.norm() * dt > least;
    turn.velocity = states_[b].velocity;
    if (turn.is_turning)
      set_rate(rate, turn);
    any = any || turn.is_turning;
  }
  if (!any) {
    turns_.clear();
    return;
  }
  arms_.resize(nodes_.x.size());
  for (std::size_t i = 0; i < arms_.size(); ++i)
    arms_[i] = nodes_.x[i] - states_[nodes_.body_of[i]].center_of_mass;
}

template <int dim>
void BodyTurn<dim>::set_rate(const AngularVector<dim>& rate, Turn& turn) const {
  turn.rate = rate;
  turn.half = rotation_of<dim>(0.5 * dt_ * rate);
  turn.whole = rotation_of<dim>(dt_ * rate);
}

/// Implicit forces hold the rest of V to a small rotation of the body as it is after `drift`.
template <int dim>
void BodyTurn<dim>::find_rotation(const std::vector<Point<dim>>& velocity) {
  if (!any())
    return;
  constexpr int n = n_rotations<dim>;
  using Inertia = Eigen::Matrix<double, n, n>;
  std::vector<double> sums(turns_.size() * (n + n * n), 0);
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    const Turn* turn = turn_at(i);
    if (!turn)
      continue;
    const Point<dim> arm = turn->whole * arms_[i];
    const Point<dim> rest = velocity[i] - rigid_velocity(i);
    double* sum = &sums[nodes_.body_of[i] * (n + n * n)];
    Eigen::Map<AngularVector<dim>>(sum, n) += nodes_.mass[i] * cross<dim>(arm, rest);
    Inertia inertia = arm.squaredNorm() * Inertia::Identity();
    if constexpr (dim == 3)
      inertia -= arm * arm.transpose();
    Eigen::Map<Inertia>(sum + n, n, n) += nodes_.mass[i] * inertia;
  }
  sum_all(nodes_.comm, sums.data(), static_cast<int>(sums.size()));
  for (std::size_t b = 0; b < turns_.size(); ++b) {
    if (!turns_[b].is_turning)
      continue;
    const double* sum = &sums[b * (n + n * n)];
    const AngularVector<dim> more = Eigen::Map<const Inertia>(sum + n, n, n)
                                        .ldlt()
                                        .solve(Eigen::Map<const AngularVector<dim>>(sum, n));
    const Orientation<dim> found = rotation_of<dim>(dt_ * more) * turns_[b].whole;
    set_rate(rotation_vector<dim>(found) / dt_, turns_[b]);
  }
}

template <int dim>
const typename BodyTurn<dim>::Turn* BodyTurn<dim>::turn_at(int node) const {
  if (!any())
    return nullptr;
  const Turn& turn = turns_[nodes_.body_of[node]];
  return turn.is_turning ? &turn : nullptr;
}

template <int dim>
template <typename Function>
Point<dim> BodyTurn<dim>::if_turning(int node, const Function& f) const {
  const Turn* turn = turn_at(node);
  return turn ? Point<dim>(f(*turn, arms_[node])) : Point<dim>(Point<dim>::Zero());
}

template <int dim>
Point<dim> BodyTurn<dim>::rigid_velocity(int node) const {
  return if_turning(node, [](const Turn& turn, const Point<dim>& arm) -> Point<dim> {
    return turn.velocity + rotate<dim>(turn.rate, arm);
  });
}

template <int dim>
Point<dim> BodyTurn<dim>::drift(int node) const {
  return if_turning(node, [this](const Turn& turn, const Point<dim>& arm) -> Point<dim> {
    return (turn.whole * arm - arm) / dt_ - rotate<dim>(turn.rate, arm);
  });
}

template <int dim>
Point<dim> BodyTurn<dim>::next_drift(int node) const {
  constexpr double longest_arc = 0.5;  // [rad]
  const Point<dim> now = drift(node);
  return if_turning(node, [this, &now](const Turn& turn, const Point<dim>&) -> Point<dim> {
    if (turn.rate.norm() * dt_ > longest_arc)
      return Point<dim>::Zero();
    return turn.whole * now;
  });
}

template <int dim>
Point<dim> BodyTurn<dim>::rise_of_arc(int node) const {
  return if_turning(node, [](const Turn& turn, const Point<dim>& arm) -> Point<dim> {
    return turn.half * arm - 0.5 * (arm + turn.whole * arm);
  });
}

template <int dim>
Point<dim> BodyTurn<dim>::change_to_end(int node) const {
  return if_turning(node, [this](const Turn& turn, const Point<dim>& arm) -> Point<dim> {
    const Point<dim> at_end = turn.whole * arm;
    return rotate<dim>(turn.rate, at_end) - (at_end - arm) / dt_;
  });
}

template class BodyTurn<2>;
template class BodyTurn<3>;

}  // namespace lockstep
