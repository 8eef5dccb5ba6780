// Bodies whose elasticity is explicit, at steps longer than their own stable one.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "deformable/deformable_solids.hpp"
#include "deformable/sub_steps.hpp"

namespace lockstep {

/// By Gershgorin's circles of M^-1 K and M^-1 B: omega dt <= sqrt 2, and for explicit damping
/// dt <= 2 / rate. The least eigenvalue of a consistent mass matrix is 1/(n_corners + 1) of the
/// lumped one's.
template <int dim>
void DeformableSolids<dim>::update_largest_stable_step() {
  constexpr double safety = 0.9;
  const int n_bodies = static_cast<int>(bodies_.size());
  std::vector<double> elastic_rate(n_bodies, 0), viscous_rate(n_bodies, 0);  // [1/s]
  for (int i = 0; i < space_.n_owned(); ++i) {
    const int b = body_of_node_[i];
    const TimeIntegration integration = bodies_[b].integration;
    if (integration == TimeIntegration::fully_implicit ||
        integration == TimeIntegration::second_order || node_mass_[i] == 0)
      continue;
    Point<dim> elastic = Point<dim>::Zero(), viscous = Point<dim>::Zero();
    for (int k = stiffness_.row_begin(i); k < stiffness_.row_end(i); ++k) {
      elastic += stiffness_.block(k).cwiseAbs().rowwise().sum();
      viscous += damping_.block(k).cwiseAbs().rowwise().sum();
    }
    elastic_rate[b] =
        std::max(elastic_rate[b], std::sqrt(elastic.maxCoeff() / (2 * least_mass(i))));
    if (integration == TimeIntegration::explicit_forces)
      viscous_rate[b] = std::max(viscous_rate[b], viscous.maxCoeff() / (2 * least_mass(i)));
  }
  max_over_ranks(comm_, elastic_rate, viscous_rate);
  largest_stable_step_ = 1e300;
  for (int b = 0; b < n_bodies; ++b) {
    Body& body = bodies_[b];
    body.elastic_step = elastic_rate[b] > 0 ? safety / elastic_rate[b] : 1e300;
    const double viscous_step = viscous_rate[b] > 0 ? safety / viscous_rate[b] : 1e300;
    largest_stable_step_ = std::min({largest_stable_step_, viscous_step,
                                     longest_sub_stepped(body.elastic_step, body.most_sub_steps)});
  }
}

template <int dim>
double DeformableSolids<dim>::least_mass(int node) const {
  return node_mass_[node] / (bodies_[body_of_node_[node]].consistent_mass ? dim + 2 : 1);
}

/// Leapfrog of elasticity and loads alone, from rest, over t = 2 dt. With the weights (1 - k/n)^2
/// of its places a mode of frequency omega feels, of its stiffness, 6/z^2 (1 - sin z/z), z = omega
/// t: slow modes all of it, fast ones what a step of dt carries, m (omega dt)^2 < 2 (never zero or
/// negative, as with equal weights), whatever mass the fluid adds. The forces at every place sum to
/// zero, and so does their mean. Nodes that a rigid body carries move here as others do: held, they
/// would pull with all of their stiffness at a body that may be too light for it, while the mean of
/// modes of all nodes is carried by any mass that is added to theirs.
///
/// The bodies go side by side, so that ranks exchange positions once a sub-step.
template <int dim>
void DeformableSolids<dim>::average_forces(const std::vector<int>& bodies, const SubSteps& steps,
                                           Nodes& force) const {
  std::vector<char> free(dim * space_.n_owned(), 1);
  for (const int dof : held_.dofs())
    free[dof] = 0;
  const bool has_ghosts = comm_->getSize() > 1;
  Nodes x = x_, velocity(space_.n_owned(), Point<dim>::Zero()), present(space_.n_local());
  for (int k = 0; k < steps.n; ++k) {
    const double weight = steps.weight(k), kick = (k == 0 ? 0.5 : 1) * steps.length;
    for (const int b : bodies) {
      const auto [owned, ghosts] = nodes_of(b);
      for (const auto& [begin, end] : {owned, ghosts})
        std::fill(present.begin() + begin, present.begin() + end, Point<dim>::Zero());
      for (const auto& group : bodies_[b].elements)
        group->add_elastic_forces(x, space_.n_owned(), present);
      for (int i = owned[0]; i < owned[1]; ++i) {
        force[i] = (k == 0 ? Point<dim>(Point<dim>::Zero()) : force[i]) + weight * present[i];
        const Point<dim> total = present[i] + node_force_[i] + node_mass_[i] * gravity_;
        for (int a = 0; a < dim; ++a) {
          if (!free[dim * i + a])
            continue;
          velocity[i][a] += kick / least_mass(i) * total[a];
          x[i][a] += steps.length * velocity[i][a];
        }
      }
    }
    if (has_ghosts && k + 1 < steps.n)
      x = space_.with_ghosts(*space_.vector(x));
  }
}

/// Numbers of nodes ascend with those of bodies, those of owned nodes and those of ghosts.
template <int dim>
std::array<std::array<int, 2>, 2> DeformableSolids<dim>::nodes_of(int body) const {
  const auto range = [&](int begin, int end) {
    const auto first = body_of_node_.begin();
    const auto found = std::equal_range(first + begin, first + end, body);
    return std::array<int, 2>{static_cast<int>(found.first - first),
                              static_cast<int>(found.second - first)};
  };
  return {range(0, space_.n_owned()), range(space_.n_owned(), space_.n_local())};
}

template <int dim>
void DeformableSolids<dim>::check_finite(const Nodes& averaged) const {
  const int n_bodies = static_cast<int>(bodies_.size());
  int crushed = n_bodies;
  for (int i = 0; i < space_.n_owned() && crushed == n_bodies; ++i) {
    if (!averaged[i].allFinite())
      crushed = body_of_node_[i];
  }
  crushed = n_bodies - static_cast<int>(max_all(comm_, GlobalIndex(n_bodies - crushed)));
  if (crushed == n_bodies)
    return;
  const Body& body = bodies_[crushed];
  const SubSteps steps = sub_steps_for(step_, body.elastic_step, body.most_sub_steps);
  check_solve(false,
              "The elastic forces of \"{}\" are not finite after {} sub-steps of {:.3g} s: its "
              "elements are crushed, and its material does not hold there. Take shorter steps, a "
              "\"Material\" that resists inversion (\"corotated\", \"neo-hookean\") or an implicit "
              "\"Time Integration\".",
              body.name, steps.n, steps.length);
}

template <int dim>
const typename DeformableSolids<dim>::Nodes& DeformableSolids<dim>::averaged_forces() const {
  const bool any = std::any_of(bodies_.begin(), bodies_.end(),
                               [](const Body& body) { return body.most_sub_steps > 1; });
  if (!any)
    return elastic_force_;
  if (averaged_force_)
    return *averaged_force_;
  averaged_force_ = elastic_force_;
  std::map<int, std::vector<int>> bodies_by_steps;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Body& body = bodies_[b];
    const int n = sub_steps_for(step_, body.elastic_step, body.most_sub_steps).n;
    if (n > 1)
      bodies_by_steps[n].push_back(static_cast<int>(b));
  }
  for (const auto& [n, bodies] : bodies_by_steps) {
    const Body& one = bodies_[bodies.front()];
    average_forces(bodies, sub_steps_for(step_, one.elastic_step, one.most_sub_steps),
                   *averaged_force_);
  }
  if (!bodies_by_steps.empty())
    check_finite(*averaged_force_);
  return *averaged_force_;
}

template <int dim>
AngularVector<dim> DeformableSolids<dim>::inner_angular_impulse(double dt) const {
  const Nodes& force = averaged_forces();
  Momentum<dim> sum;
  for (int i = 0; i < space_.n_owned(); ++i)
    sum.add(x_[i], dt * force[i] + (limiting_impulse_.empty() ? Point<dim>(Point<dim>::Zero())
                                                              : limiting_impulse_[i]));
  return sum_over_ranks<dim>(sum, comm_).angular;
}

template void DeformableSolids<2>::update_largest_stable_step();
template void DeformableSolids<3>::update_largest_stable_step();
template double DeformableSolids<2>::least_mass(int) const;
template double DeformableSolids<3>::least_mass(int) const;
template const std::vector<Point<2>>& DeformableSolids<2>::averaged_forces() const;
template const std::vector<Point<3>>& DeformableSolids<3>::averaged_forces() const;
template AngularVector<2> DeformableSolids<2>::inner_angular_impulse(double) const;
template AngularVector<3> DeformableSolids<3>::inner_angular_impulse(double) const;
template void DeformableSolids<2>::average_forces(const std::vector<int>&, const SubSteps&,
                                                  Nodes&) const;
template void DeformableSolids<2>::check_finite(const Nodes&) const;
template std::array<std::array<int, 2>, 2> DeformableSolids<2>::nodes_of(int) const;
template void DeformableSolids<3>::average_forces(const std::vector<int>&, const SubSteps&,
                                                  Nodes&) const;
template void DeformableSolids<3>::check_finite(const Nodes&) const;
template std::array<std::array<int, 2>, 2> DeformableSolids<3>::nodes_of(int) const;

}  // namespace lockstep
