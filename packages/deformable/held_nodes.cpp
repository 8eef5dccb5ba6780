#include "deformable/held_nodes.hpp"

#include <cmath>

#include "base/round_off.hpp"

namespace lockstep {

template <int dim>
int HeldNodes<dim>::add(const NodeHold<dim>& hold) {
  holds_.push_back(hold);
  released_.push_back(hold.release_time <= start_time_);
  return static_cast<int>(holds_.size()) - 1;
}

template <int dim>
void HeldNodes<dim>::hold(int node, int axis, const Point<dim>& at, int number) {
  dofs_.push_back({dim * node + axis, number, at});
}

template <int dim>
bool HeldNodes<dim>::begin_step(double time) {
  constexpr double round_off = rounding::sums;
  const std::vector<char> before = released_;
  for (std::size_t h = 0; h < holds_.size(); ++h)
    released_[h] = holds_[h].release_time <= time + round_off * std::abs(time);
  return released_ != before;
}

template <int dim>
std::vector<int> HeldNodes<dim>::dofs() const {
  std::vector<int> held;
  for (const Dof& dof : dofs_) {
    if (is_held(dof))
      held.push_back(dof.dof);
  }
  return held;
}

/// Relative to the start: a script of one axis turns by the difference of its angles.
template <int dim>
std::vector<typename HeldNodes<dim>::Pose> HeldNodes<dim>::poses(double time) const {
  std::vector<Pose> all;
  for (const NodeHold<dim>& hold : holds_) {
    ScriptedMotion<dim> start, now;
    if (hold.script) {
      start = hold.script(start_time_);
      now = hold.script(time);
    }
    const AngularVector<dim> turn = now.turn - start.turn;
    all.push_back({now.displacement - start.displacement, now.velocity,
                   rotation_of<dim>(turn).toRotationMatrix(), now.angular_velocity});
  }
  return all;
}

template <int dim>
std::vector<double> HeldNodes<dim>::velocities(double begin, double end) const {
  const std::vector<Pose> before = poses(begin), after = poses(end);
  std::vector<double> result;
  for (const Dof& dof : dofs_) {
    if (!is_held(dof))
      continue;
    Point<dim> velocity = Point<dim>::Zero();
    if (dof.hold >= 0) {
      const Pose &p = before[dof.hold], &q = after[dof.hold];
      const Point<dim> start = dof.start - holds_[dof.hold].origin, arm = q.rotation * start;
      if (end > begin) {
        velocity = (q.displacement - p.displacement + arm - Point<dim>(p.rotation * start)) /
                   (end - begin);
      } else {
        velocity = q.velocity + rotate<dim>(q.angular_velocity, arm);
      }
    }
    result.push_back(velocity[dof.dof % dim]);
  }
  return result;
}

template class HeldNodes<2>;
template class HeldNodes<3>;

}  // namespace lockstep
