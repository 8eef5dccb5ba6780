#include "deformable/explicit_elasticity.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"

namespace lockstep {

template <int dim>
void ExplicitElasticity<dim>::begin_step(double dt, bool holds_others) {
  if (holds_others ||
      dt != step_)  // else S2 of the last step has averaged them where S1 needs them
    averaged_.reset();
  step_ = dt;
}

/// By Gershgorin's circles of M^-1 K and M^-1 B: omega dt <= sqrt 2, and for explicit damping
/// dt <= 2 / rate. The least eigenvalue of a consistent mass matrix is 1/(n_corners + 1) of the
/// lumped one's.
template <int dim>
void ExplicitElasticity<dim>::update_largest_stable_step() {
  constexpr double safety = 0.9;
  const NodeMatrix<dim>&stiffness = forces_.stiffness, &damping = forces_.damping;
  const int n_bodies = nodes_.n_bodies();
  std::vector<double> rates(2 * n_bodies, 0);  // rates of each body: elastic, viscous [1/s]
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    const int b = nodes_.body_of[i];
    if (nodes_.bodies[b].is_implicit() || nodes_.mass[i] == 0)
      continue;
    Point<dim> elastic = Point<dim>::Zero(), viscous = Point<dim>::Zero();
    for (int k = stiffness.row_begin(i); k < stiffness.row_end(i); ++k) {
      elastic += stiffness.block(k).cwiseAbs().rowwise().sum();
      viscous += damping.block(k).cwiseAbs().rowwise().sum();
    }
    rates[2 * b] =
        std::max(rates[2 * b], std::sqrt(elastic.maxCoeff() / (2 * nodes_.least_mass(i))));
    if (nodes_.bodies[b].is_explicit())
      rates[2 * b + 1] =
          std::max(rates[2 * b + 1], viscous.maxCoeff() / (2 * nodes_.least_mass(i)));
  }
  MPI_Allreduce(MPI_IN_PLACE, rates.data(), 2 * n_bodies, MPI_DOUBLE, MPI_MAX,
                raw_communicator(nodes_.comm));
  largest_stable_step_ = {};
  for (int b = 0; b < n_bodies; ++b) {
    elastic_step_[b] = rates[2 * b] > 0 ? safety / rates[2 * b] : 1e300;
    const double viscous_step = rates[2 * b + 1] > 0 ? safety / rates[2 * b + 1] : 1e300;
    const SoftBody& body = nodes_.bodies[b];
    const double longest =
        std::min(viscous_step, longest_sub_stepped(elastic_step_[b], body.most_sub_steps));
    if (longest < largest_stable_step_.dt)
      largest_stable_step_ = {
          longest, "stiffest element of " + body.name,
          "No element bounds it with \"Time Integration\" = fully-implicit of that solid."};
  }
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
void ExplicitElasticity<dim>::average_forces(const std::vector<int>& bodies, const SubSteps& steps,
                                             Nodes& force) const {
  std::vector<char> free(dim * nodes_.n_owned(), 1);
  for (const int dof : nodes_.held.dofs())
    free[dof] = 0;
  const bool has_ghosts = nodes_.comm->getSize() > 1;
  Nodes x = nodes_.x, velocity(nodes_.n_owned(), Point<dim>::Zero()),
        present(nodes_.space.n_local());
  for (int k = 0; k < steps.n; ++k) {
    const double weight = steps.weight(k), kick = (k == 0 ? 0.5 : 1) * steps.length;
    for (const int b : bodies) {
      const auto [owned, ghosts] = nodes_of(b);
      for (const auto& [begin, end] : {owned, ghosts})
        std::fill(present.begin() + begin, present.begin() + end, Point<dim>::Zero());
      for (const auto& group : forces_.elements[b])
        group->add_elastic_forces(x, nodes_.n_owned(), present);
      for (int i = owned[0]; i < owned[1]; ++i) {
        force[i] = (k == 0 ? Point<dim>(Point<dim>::Zero()) : force[i]) + weight * present[i];
        const Point<dim> total = present[i] + nodes_.load[i] + nodes_.mass[i] * nodes_.gravity;
        for (int a = 0; a < dim; ++a) {
          if (!free[dim * i + a])
            continue;
          velocity[i][a] += kick / nodes_.least_mass(i) * total[a];
          x[i][a] += steps.length * velocity[i][a];
        }
      }
    }
    if (has_ghosts && k + 1 < steps.n)
      x = nodes_.space.with_ghosts(*nodes_.space.vector(x));
  }
}

/// Numbers of nodes ascend with those of bodies, those of owned nodes and those of ghosts.
template <int dim>
std::array<std::array<int, 2>, 2> ExplicitElasticity<dim>::nodes_of(int body) const {
  const auto range = [&](int begin, int end) {
    const auto first = nodes_.body_of.begin();
    const auto found = std::equal_range(first + begin, first + end, body);
    return std::array<int, 2>{static_cast<int>(found.first - first),
                              static_cast<int>(found.second - first)};
  };
  return {range(0, nodes_.n_owned()), range(nodes_.n_owned(), nodes_.space.n_local())};
}

template <int dim>
void ExplicitElasticity<dim>::check_finite(const Nodes& averaged) const {
  const int n_bodies = nodes_.n_bodies();
  int crushed = n_bodies;
  for (int i = 0; i < nodes_.n_owned() && crushed == n_bodies; ++i) {
    if (!averaged[i].allFinite())
      crushed = nodes_.body_of[i];
  }
  crushed = n_bodies - static_cast<int>(max_all(nodes_.comm, GlobalIndex(n_bodies - crushed)));
  if (crushed == n_bodies)
    return;
  const SubSteps steps = steps_of(crushed);
  check_solve(false,
              "The elastic forces of \"{}\" are not finite after {} sub-steps of {:.3g} s: its "
              "elements are crushed, and its material does not hold there. Take shorter steps, a "
              "\"Material\" that resists inversion (\"corotated\", \"neo-hookean\") or an implicit "
              "\"Time Integration\".",
              nodes_.bodies[crushed].name, steps.n, steps.length);
}

template <int dim>
const std::vector<Point<dim>>& ExplicitElasticity<dim>::averaged_forces() const {
  if (std::none_of(nodes_.bodies.begin(), nodes_.bodies.end(),
                   [](const SoftBody& body) { return body.most_sub_steps > 1; }))
    return forces_.elastic;
  if (averaged_ && averaged_number_ == forces_.number)
    return *averaged_;
  averaged_ = forces_.elastic;
  averaged_number_ = forces_.number;
  std::map<int, std::vector<int>> bodies_by_steps;
  for (int b = 0; b < nodes_.n_bodies(); ++b) {
    if (const int n = steps_of(b).n; n > 1)
      bodies_by_steps[n].push_back(b);
  }
  for (const auto& [n, bodies] : bodies_by_steps)
    average_forces(bodies, steps_of(bodies.front()), *averaged_);
  if (!bodies_by_steps.empty())
    check_finite(*averaged_);
  return *averaged_;
}

template class ExplicitElasticity<2>;
template class ExplicitElasticity<3>;

}  // namespace lockstep
