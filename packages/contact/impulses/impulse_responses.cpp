// The parts of ImpulseSolver for solids that answer an impulse as a whole.
#include <cmath>

#include "contact/impulses/impulse_solver.hpp"

namespace lockstep {

template <int dim>
int ImpulseSolver<dim>::activate(int dof) {
  const int id = mobility_.activate(dof);
  if (id == static_cast<int>(active_.size()))
    active_.push_back(velocity_[dof]);
  return id;
}

/// Finds the response of active dofs, whose columns are stored.
template <int dim>
void ImpulseSolver<dim>::find_response(const Row& row, Compliance& compliance,
                                       double& of_parts) const {
  for (int k = row.begin; k < row.end; ++k) {
    const GrowingColumn& column = mobility_.column(jacobian_[k].id);
    Point<dim> velocity = Point<dim>::Zero();
    for (int j = row.begin; j < row.end; ++j)
      velocity += column[jacobian_[j].id] * jacobian_[j].coefficient;
    compliance += velocity * jacobian_[k].coefficient.transpose();
    of_parts +=
        column[jacobian_[k].id] * std::pow(row.contact.normal.dot(jacobian_[k].coefficient), 2);
  }
}

/// Dofs have become active since limits were added.
template <int dim>
void ImpulseSolver<dim>::extend_limits() {
  for (int k = 0; k < limits_.size() && responds(); ++k) {
    const auto weights = limits_.row(k).weights;
    for (auto id = static_cast<int>(limits_.row(k).response.size()); id < mobility_.n_active();
         ++id) {
      double velocity = 0;
      for (const auto& [other, weight] : weights)
        velocity += weight * mobility_.column(other)[id];
      limits_.extend(k, id, velocity);
    }
  }
}

/// Computes the velocities of all dofs: sweeps have followed the active ones alone.
template <int dim>
void ImpulseSolver<dim>::find_velocity() {
  std::vector<double> of_active(active_.size(), 0);
  for (const Row& row : rows_) {
    const Point<dim> pushed = row.frame * row.impulse;
    for (int k = row.begin; k < row.end; ++k)
      of_active[jacobian_[k].id] += jacobian_[k].coefficient.dot(pushed);
  }
  limits_.add_to(of_active);
  std::vector<double> impulses(velocity_.size(), 0);
  for (std::size_t id = 0; id < of_active.size(); ++id)
    impulses[dof_of(static_cast<int>(id))] += of_active[id];
  const std::vector<double> change = mobility_.velocities(std::move(impulses));
  for (std::size_t dof = 0; dof < velocity_.size(); ++dof)
    velocity_[dof] = given_[dof] + change[dof];
  for (std::size_t id = 0; id < active_.size(); ++id)
    velocity_[dof_of(static_cast<int>(id))] = active_[id];
}

template <int dim>
void ImpulseSolver<dim>::take_out_given(HeldRow& row) const {
  Terms left;
  for (const auto& [dof, weight] : row.weights) {
    const int id = static_cast<int>(dof);
    if (mobility_.is_held(id) && !shapes_.follows(dof)) {
      row.velocity -= weight * velocity_[id];
      row.on_given.emplace_back(dof, weight);
    } else if (weight != 0) {
      left.emplace_back(dof, weight);
    }
  }
  row.weights = std::move(left);
}

template <int dim>
template <typename Function>
void ImpulseSolver<dim>::for_each_held(const Function& f) const {
  for (const Row& row : rows_) {
    if (!row.pushes())
      continue;
    f(row, row.contact.normal, row.target, row.impulse[0], row.normal_response);
    for (int k = 1; k < dim && !row.slides(); ++k)
      f(row, row.frame.col(k), 0, row.impulse[k], row.tangent_response);
  }
}

template <int dim>
std::vector<HeldRow> ImpulseSolver<dim>::held_rows() const {
  std::vector<HeldRow> held;
  for_each_held([&](const Row& row, const Point<dim>& direction, double velocity, double impulse,
                    double response) {
    HeldRow one{impulse_on_both(row, direction), velocity - direction.dot(row.of_given), impulse,
                response};
    take_out_given(one);
    held.push_back(std::move(one));
  });
  return held;
}

template <int dim>
void ImpulseSolver<dim>::add_pushes(const Row& row, const Point<dim>& impulse, int number,
                                    std::vector<PrescribedPush<dim>>& pushes) const {
  const auto add = [&](const ContactSide<dim>& side, double sign) {
    if (side.solid < 0 || !shapes_.solids()[side.solid].prescribed)
      return;
    PrescribedPush<dim> push{number, side.solid, {}};
    push.impulse.add(side.x, sign * impulse);
    pushes.push_back(push);
  };
  add(row.solid_side(), 1);
  add(row.other_side(), -1);
}

template <int dim>
std::vector<PrescribedPush<dim>> ImpulseSolver<dim>::held_pushes() const {
  std::vector<PrescribedPush<dim>> pushes;
  int number = 0;
  for_each_held([&](const Row& row, const Point<dim>& direction, double, double, double) {
    add_pushes(row, direction, number++, pushes);
  });
  for (const Row& row : rows_) {
    if (row.pushes() && row.slides())
      add_pushes(row, row.of_friction(), PrescribedPush<dim>::whole, pushes);
  }
  return pushes;
}

template <int dim>
std::vector<PrescribedPush<dim>> ImpulseSolver<dim>::pushes() const {
  std::vector<PrescribedPush<dim>> pushes;
  for (const Row& row : rows_)
    add_pushes(row, row.frame * row.impulse, PrescribedPush<dim>::whole, pushes);
  return pushes;
}

template <int dim>
typename ImpulseSolver<dim>::Terms ImpulseSolver<dim>::sliding_impulse(Terms& on_given) const {
  HeldRow all;
  for (const Row& row : rows_) {
    if (!row.pushes() || !row.slides())
      continue;
    for (const auto& term : impulse_on_both(row, row.of_friction()))
      all.weights.push_back(term);
  }
  take_out_given(all);
  on_given = std::move(all.on_given);
  return all.weights;
}

template int ImpulseSolver<2>::activate(int);
template void ImpulseSolver<2>::find_response(const Row&, Compliance&, double&) const;
template void ImpulseSolver<2>::extend_limits();
template void ImpulseSolver<2>::find_velocity();
template void ImpulseSolver<2>::take_out_given(HeldRow&) const;
template std::vector<HeldRow> ImpulseSolver<2>::held_rows() const;
template std::vector<PrescribedPush<2>> ImpulseSolver<2>::held_pushes() const;
template std::vector<PrescribedPush<2>> ImpulseSolver<2>::pushes() const;
template ImpulseSolver<2>::Terms ImpulseSolver<2>::sliding_impulse(Terms&) const;
template int ImpulseSolver<3>::activate(int);
template void ImpulseSolver<3>::find_response(const Row&, Compliance&, double&) const;
template void ImpulseSolver<3>::extend_limits();
template void ImpulseSolver<3>::find_velocity();
template void ImpulseSolver<3>::take_out_given(HeldRow&) const;
template std::vector<HeldRow> ImpulseSolver<3>::held_rows() const;
template std::vector<PrescribedPush<3>> ImpulseSolver<3>::held_pushes() const;
template std::vector<PrescribedPush<3>> ImpulseSolver<3>::pushes() const;
template ImpulseSolver<3>::Terms ImpulseSolver<3>::sliding_impulse(Terms&) const;

}  // namespace lockstep
