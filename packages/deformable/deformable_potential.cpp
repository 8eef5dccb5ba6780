// The energy of elastic forces that are implicit, along the velocities that a solve may find.
#include <algorithm>
#include <cmath>
#include <limits>

#include "deformable/deformable_solids.hpp"

namespace lockstep {

template <int dim>
bool DeformableSolids<dim>::has_implicit_forces() const {
  return std::any_of(bodies_.begin(), bodies_.end(),
                     [this](const Body& body) { return elastic_share(body) > 0; });
}

/// With the share s of dt the forces are those at x + s dt V, of the potential E(x + s dt V)/s in
/// V. The model is -dt f.V + s dt^2/2 V.K V, with the f that `linearise` leaves. Elements' energies
/// are differences of numbers as large as they are at a strain of one.
template <int dim>
std::vector<ComputedEnergy> DeformableSolids<dim>::nonlinear_energies(
    double dt, const Vector& velocity) const {
  const auto share = [this](int node) { return elastic_share(bodies_[body_of_node_[node]]); };
  const Nodes v = space_.with_ghosts(velocity);
  Nodes x = before_ ? *before_ : x_;
  for (int i = 0; i < space_.n_local(); ++i)
    x[i] += share(i) * dt * v[i];
  const std::size_t n = bodies_.size();
  std::vector<double> energy(n, 0), size(n, 0);
  Nodes ignored(space_.n_local(), Point<dim>::Zero());
  for (std::size_t b = 0; b < n; ++b) {
    const Body& body = bodies_[b];
    const double part = elastic_share(body);
    for (std::size_t k = 0; k < body.elements.size() && part > 0; ++k) {
      energy[b] += body.softening / part *
                   body.elements[k]->add_elastic_forces(x, space_.n_owned(), ignored);
    }
  }
  for (int i = 0; i < space_.n_owned(); ++i) {
    if (share(i) == 0)
      continue;
    const int b = body_of_node_[i];
    const Point<dim> stiff = share(i) * dt * stiffness_.row_times(i, v);
    energy[b] += dt * v[i].dot(elastic_force_[i] - 0.5 * stiff);
    for (int k = stiffness_.row_begin(i); k < stiffness_.row_end(i); ++k) {
      const double length = (x[stiffness_.column(k)] - x[i]).squaredNorm();
      size[b] += stiffness_.block(k).cwiseAbs().sum() * length / share(i);
    }
  }
  sum_over_ranks(comm_, energy, size);
  std::vector<ComputedEnergy> energies;
  for (std::size_t b = 0; b < n; ++b)
    energies.push_back({energy[b], 4 * std::numeric_limits<double>::epsilon() * size[b]});
  return energies;
}

/// Works of the forces in `explicit_momentum` and D; the work of the stretch limit counts as
/// elastic.
template <int dim>
SolidWork DeformableSolids<dim>::solid_work(double, double dt, const Vector& velocity,
                                            const Vector& mean) const {
  const Nodes found = space_.with_ghosts(velocity), before = space_.with_ghosts(*velocity_),
              rate = space_.owned(mean);
  const Nodes& elastic = averaged_forces();
  SolidWork work;
  for (int i = 0; i < space_.n_owned(); ++i) {
    const Body& body = bodies_[body_of_node_[i]];
    Point<dim> impulse = dt * elastic[i];
    if (const double share = elastic_share(body); share > 0)
      impulse -= share * dt * dt * stiffness_.row_times(i, found);
    if (!limiting_impulse_.empty())
      impulse += limiting_impulse_[i];
    const bool is_explicit = body.integration == TimeIntegration::explicit_forces;
    work.elastic += rate[i].dot(impulse);
    work.damping -= dt * rate[i].dot(damping_.row_times(i, is_explicit ? before : found));
    work.loads += dt * rate[i].dot(node_force_[i] + node_mass_[i] * gravity_);
  }
  sum_over_ranks(comm_, work.elastic, work.damping, work.loads);
  return work;
}

/// By Gershgorin's circles of M^-1 K, with the mass of fluid that moves along.
template <int dim>
void DeformableSolids<dim>::bound_frequencies() {
  std::vector<double> squares(bodies_.size(), 0);
  for (int i = 0; i < space_.n_owned(); ++i) {
    const Body& body = bodies_[body_of_node_[i]];
    const double mass = least_mass(i) + body.fluid_mass * node_share_[i];
    if (mass == 0)
      continue;
    Point<dim> sum = Point<dim>::Zero();
    for (int k = stiffness_.row_begin(i); k < stiffness_.row_end(i); ++k)
      sum += stiffness_.block(k).cwiseAbs().rowwise().sum();
    double& square = squares[body_of_node_[i]];
    square = std::max(square, sum.maxCoeff() / mass);
  }
  max_over_ranks(comm_, squares);
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    bodies_[b].stiffest_rate = std::sqrt(squares[b]);
}

/// Beyond a = omega dt of some 1e4 round-off of a^2 M_S drowns the inertia of a free body's rigid
/// motions in C, so nothing could be solved; the body is made as soft as that. What moves it by a
/// length l within a step strains it by l/(a^2 h) at most. What is held has no such motions.
template <int dim>
void DeformableSolids<dim>::soften(double dt) {
  constexpr double stiffest = 1e4;
  std::vector<double> n_held(bodies_.size(), 0);
  for (const int dof : held_.dofs())
    ++n_held[body_of_node_[dof / dim]];
  for (const auto& attached : attached_)
    ++n_held[body_of_node_[attached.first]];
  sum_over_ranks(comm_, n_held);
  bool changed = false;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    Body& body = bodies_[b];
    const double a = n_held[b] > 0 ? 0 : body.stiffest_rate * dt;
    const double softening =
        elastic_share(body) > 0 && a > stiffest ? stiffest / a * (stiffest / a) : 1;
    changed = changed || softening != body.softening;
    body.softening = softening;
  }
  if (changed)
    update_forces();
}

/// Forces at the end of the step, for half of which they act, are late: of the strain that the
/// present velocity makes in the step they see all, where a third would be right. Given back is
/// half of it, of second order a quarter, the most that leaves every mode damped.
template <int dim>
void DeformableSolids<dim>::add_midpoint_correction(double dt, Vector& momentum) const {
  if (!has_implicit_forces())
    return;
  const Nodes v = space_.with_ghosts(*velocity_);
  const auto values = momentum.getDataNonConst();
  for (int i = 0; i < space_.n_owned(); ++i) {
    const Body& body = bodies_[body_of_node_[i]];
    if (elastic_share(body) == 0)
      continue;
    const double part = body.integration == TimeIntegration::second_order ? 0.5 : 1;
    const Point<dim> impulse = part * dt * dt * stiffness_.row_times(i, v);
    for (int a = 0; a < dim; ++a)
      values[dim * i + a] += impulse[a];
  }
}

template SolidWork DeformableSolids<2>::solid_work(double, double, const Vector&,
                                                   const Vector&) const;
template SolidWork DeformableSolids<3>::solid_work(double, double, const Vector&,
                                                   const Vector&) const;
template void DeformableSolids<2>::bound_frequencies();
template void DeformableSolids<3>::bound_frequencies();
template void DeformableSolids<2>::soften(double);
template void DeformableSolids<3>::soften(double);
template void DeformableSolids<2>::add_midpoint_correction(double, Vector&) const;
template void DeformableSolids<3>::add_midpoint_correction(double, Vector&) const;
template bool DeformableSolids<2>::has_implicit_forces() const;
template bool DeformableSolids<3>::has_implicit_forces() const;
template std::vector<ComputedEnergy> DeformableSolids<2>::nonlinear_energies(double,
                                                                             const Vector&) const;
template std::vector<ComputedEnergy> DeformableSolids<3>::nonlinear_energies(double,
                                                                             const Vector&) const;

}  // namespace lockstep
