#include "deformable/body_states.hpp"

#include <Eigen/Dense>
#include <Tpetra_Vector.hpp>

namespace lockstep {

template <int dim>
std::vector<SolidState<dim>> body_states(const BodyNodes<dim>& nodes,
                                         const NodalSurface<dim>& surface,
                                         const std::vector<double>& elastic_energy) {
  constexpr int n_turns = n_rotations<dim>;
  using Inertia = Eigen::Matrix<double, n_turns, n_turns>;
  // Mass times position, momentum, twice the kinetic energy.
  constexpr int n_first = 2 * dim + 1, n_second = n_turns + n_turns * n_turns;
  const int n_bodies = nodes.n_bodies();
  const auto q = make_vector(nodes.space.dof_map());
  apply(*nodes.mass_matrix, *nodes.velocity, *q);
  const std::vector<Point<dim>> momentum = nodes.space.owned(*q),
                                velocity = nodes.space.owned(*nodes.velocity);
  // A massless body has the means of its surface.
  const auto is_massless = [&](int i) { return nodes.body(i).mass == 0; };
  const auto weight = [&](int i) { return is_massless(i) ? nodes.share[i] : nodes.mass[i]; };
  const auto weighted = [&](int i) -> Point<dim> {
    return is_massless(i) ? Point<dim>(nodes.share[i] * velocity[i]) : momentum[i];
  };
  std::vector<double> first(n_bodies * n_first, 0), second(n_bodies * n_second, 0);
  for (int i = 0; i < nodes.n_owned(); ++i) {
    double* sum = &first[nodes.body_of[i] * n_first];
    Eigen::Map<Point<dim>>(sum, dim) += weight(i) * nodes.x[i];
    Eigen::Map<Point<dim>>(sum + dim, dim) += weighted(i);
    sum[2 * dim] += momentum[i].dot(velocity[i]);
  }
  sum_all(nodes.comm, first.data(), static_cast<int>(first.size()));
  std::vector<SolidState<dim>> states(n_bodies);
  for (int b = 0; b < n_bodies; ++b) {
    SolidState<dim>& state = states[b];
    state.name = nodes.bodies[b].name;
    state.mass = nodes.bodies[b].mass;
    const double total = state.mass > 0 ? state.mass : 1;
    state.center_of_mass = Eigen::Map<Point<dim>>(&first[b * n_first], dim) / total;
    state.velocity = Eigen::Map<Point<dim>>(&first[b * n_first + dim], dim) / total;
    state.kinetic_energy = 0.5 * first[b * n_first + 2 * dim];
    state.elastic_energy = elastic_energy[b];
    const SolidDescription& solid = surface.solids()[b];
    for (int s = solid.simplex_begin; solid.closed && s < solid.simplex_end; ++s) {
      const auto corners = surface.corners(s, surface.mesh().vertices);
      state.volume += area_vector<dim>(corners).dot(corners[0] - state.center_of_mass) / dim;
    }
  }
  for (int i = 0; i < nodes.n_owned(); ++i) {
    const int b = nodes.body_of[i];
    const Point<dim> arm = nodes.x[i] - states[b].center_of_mass;
    double* sum = &second[b * n_second];
    Eigen::Map<AngularVector<dim>>(sum, n_turns) += cross<dim>(arm, weighted(i));
    Inertia inertia = arm.squaredNorm() * Inertia::Identity();
    if constexpr (dim == 3)
      inertia -= arm * arm.transpose();
    Eigen::Map<Inertia>(sum + n_turns, n_turns, n_turns) += weight(i) * inertia;
  }
  sum_all(nodes.comm, second.data(), static_cast<int>(second.size()));
  for (int b = 0; b < n_bodies; ++b) {
    const AngularVector<dim> angular =
        Eigen::Map<AngularVector<dim>>(&second[b * n_second], n_turns);
    const Inertia inertia = Eigen::Map<Inertia>(&second[b * n_second + n_turns], n_turns, n_turns);
    states[b].angular_velocity = inertia.ldlt().solve(angular);
  }
  return states;
}

template std::vector<SolidState<2>> body_states(const BodyNodes<2>&, const NodalSurface<2>&,
                                                const std::vector<double>&);
template std::vector<SolidState<3>> body_states(const BodyNodes<3>&, const NodalSurface<3>&,
                                                const std::vector<double>&);

}  // namespace lockstep
