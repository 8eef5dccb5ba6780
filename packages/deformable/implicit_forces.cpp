#include "deformable/implicit_forces.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lockstep {

template <int dim>
ImplicitForces<dim>::ImplicitForces(const BodyNodes<dim>& nodes, const BodyTurn<dim>& turn,
                                    ElementForces<dim>& forces)
    : nodes_(nodes), turn_(turn), forces_(forces), stiffest_rate_(nodes.bodies.size(), 0) {}

template <int dim>
bool ImplicitForces<dim>::any() const {
  return std::any_of(nodes_.bodies.begin(), nodes_.bodies.end(),
                     [](const SoftBody& body) { return body.is_implicit(); });
}

template <int dim>
double ImplicitForces<dim>::share(const SoftBody& body) const {
  if (!body.is_implicit())
    return 0;
  if (!moved_)
    return 2;
  return body.is_second_order() ? 0.5 : 1;
}

template <int dim>
RCP<const LinearOperator> ImplicitForces<dim>::implicit_force(double dt) const {
  if (!implicit_force_.is_null() && implicit_force_dt_ == dt)
    return implicit_force_;
  if (std::all_of(nodes_.bodies.begin(), nodes_.bodies.end(),
                  [](const SoftBody& body) { return body.is_explicit(); }))
    return Teuchos::null;
  NodeMatrix<dim> sum = forces_.stiffness;
  sum.set_zero();
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    if (nodes_.body(i).is_explicit())
      continue;
    sum.add_row(i, -1, forces_.damping);
    if (const double part = share_at(i); part > 0)
      sum.add_row(i, -part * dt, forces_.stiffness);
  }
  implicit_force_ = as_operator(nodes_.space.matrix(sum));
  implicit_force_dt_ = dt;
  return implicit_force_;
}

/// Forces at the end of the step, for half of which they act, are late: of the strain that the
/// present velocity makes in the step they see all, where a third would be right. Given back is
/// half of it, of second order a quarter, the most that leaves every mode damped. Rigid motions
/// strain nothing, which a stiffness of turned positions does not know.
template <int dim>
void ImplicitForces<dim>::add_midpoint_correction(double dt, Vector& momentum) const {
  if (!any())
    return;
  Nodes v = nodes_.space.with_ghosts(*nodes_.velocity);
  for (int i = 0; turn_.any() && i < nodes_.space.n_local(); ++i)
    v[i] -= turn_.rigid_velocity(i);
  const auto values = momentum.getDataNonConst();
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    if (!nodes_.body(i).is_implicit())
      continue;
    const double part = nodes_.body(i).is_second_order() ? 0.5 : 1;
    const Point<dim> impulse = part * dt * dt * forces_.stiffness.row_times(i, v);
    for (int a = 0; a < dim; ++a)
      values[dim * i + a] += impulse[a];
  }
}

/// By Gershgorin's circles of M^-1 K, with the mass of fluid that moves along.
template <int dim>
void ImplicitForces<dim>::bound_frequencies() {
  std::vector<double> squares(nodes_.bodies.size(), 0);
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    const double mass = nodes_.least_mass(i) + nodes_.body(i).fluid_mass * nodes_.share[i];
    if (mass == 0)
      continue;
    Point<dim> sum = Point<dim>::Zero();
    for (int k = forces_.stiffness.row_begin(i); k < forces_.stiffness.row_end(i); ++k)
      sum += forces_.stiffness.block(k).cwiseAbs().rowwise().sum();
    double& square = squares[nodes_.body_of[i]];
    square = std::max(square, sum.maxCoeff() / mass);
  }
  MPI_Allreduce(MPI_IN_PLACE, squares.data(), static_cast<int>(squares.size()), MPI_DOUBLE, MPI_MAX,
                raw_communicator(nodes_.comm));
  for (std::size_t b = 0; b < squares.size(); ++b)
    stiffest_rate_[b] = std::sqrt(squares[b]);
}

/// Beyond a = omega dt of some 1e4 round-off of a^2 M_S drowns the inertia of a free body's rigid
/// motions in C, so nothing could be solved; the body is made as soft as that. What moves it by a
/// length l within a step strains it by l/(a^2 h) at most. What is held has no such motions.
template <int dim>
void ImplicitForces<dim>::soften(double dt, const std::vector<char>& is_free) {
  constexpr double stiffest = 1e4;
  bool changed = false;
  for (std::size_t b = 0; b < is_free.size(); ++b) {
    const double a = is_free[b] == 0 ? 0 : stiffest_rate_[b] * dt;
    const double softening =
        nodes_.bodies[b].is_implicit() && a > stiffest ? stiffest / a * (stiffest / a) : 1;
    changed = changed || softening != forces_.softening[b];
    forces_.softening[b] = softening;
  }
  if (changed)
    update();
}

template <int dim>
void ImplicitForces<dim>::look_ahead() {
  beside_.clear();
  if (!turn_.any())
    return;
  Nodes rigid(nodes_.n_owned());
  for (int i = 0; i < nodes_.n_owned(); ++i)
    rigid[i] = turn_.rigid_velocity(i);
  for (int i = 0; i < nodes_.space.n_local(); ++i)
    beside_.push_back(turn_.dt() * turn_.drift(i));
  linearise(0.5 * turn_.dt(), *nodes_.space.vector(rigid));  // S1 is over half of the step
}

/// Forces of second order are linearised at the middle of the way and about the velocity at its
/// end, both without what S2 does.
template <int dim>
void ImplicitForces<dim>::moved(Nodes before, double dt) {
  moved_ = true;
  beside_.clear();
  linearisation_ = Teuchos::null;
  if (dt == 0 || std::none_of(nodes_.bodies.begin(), nodes_.bodies.end(),
                              [](const SoftBody& body) { return body.is_second_order(); }))
    return;
  before_ = std::move(before);
  moved_dt_ = dt;
  Nodes velocity(nodes_.space.n_local(), Point<dim>::Zero());
  if (turn_.any())
    beside_.assign(velocity.size(), Point<dim>::Zero());
  for (int i = 0; i < nodes_.space.n_local(); ++i) {
    if (!nodes_.body(i).is_second_order()) {
      (*before_)[i] = nodes_.x[i];
      continue;
    }
    const Point<dim> to_end = turn_.change_to_end(i);
    velocity[i] = (nodes_.x[i] - (*before_)[i]) / dt + to_end;
    if (turn_.any())
      beside_[i] = turn_.rise_of_arc(i) - 0.5 * dt * to_end;
  }
  linearisation_ = nodes_.space.vector(velocity);
}

/// Forces of S2 are halfway.
template <int dim>
void ImplicitForces<dim>::update() {
  linearised_ = false;
  if (before_)
    linearise(moved_dt_, Vector(*linearisation_, Teuchos::Copy));
  else
    assemble(nodes_.x);
}

template <int dim>
void ImplicitForces<dim>::end_step(bool changed) {
  before_.reset();
  beside_.clear();
  moved_ = false;
  linearisation_ = Teuchos::null;
  implicit_force_ = Teuchos::null;  // S1 needs another one
  if (linearised_ || changed)
    update();
}

/// With x* = x + dt V the force of the next V' is f(x*) - dt K(x*) (V' - V): explicit is f + dt K
/// V. Of second order, in S2: x and dt are those at the start and half of the step. Bodies that
/// turn are turned along (`reached`).
template <int dim>
void ImplicitForces<dim>::linearise(double dt, const Vector& velocity) {
  const Nodes v = nodes_.space.with_ghosts(velocity);
  assemble(reached(dt, v));
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    if (share_at(i) > 0)
      forces_.elastic[i] += share_at(i) * dt * forces_.stiffness.row_times(i, v);
  }
  linearised_ = true;
  linearisation_ = rcp(new Vector(velocity, Teuchos::Copy));
}

/// With the share s of dt the forces are those at x + s dt V, of the potential E(x + s dt V)/s in
/// V. The model is -dt f.V + s dt^2/2 V.K V, with the f that `linearise` leaves. Elements' energies
/// are differences of numbers as large as they are at a strain of one.
template <int dim>
std::vector<ComputedEnergy> ImplicitForces<dim>::nonlinear_energies(double dt,
                                                                    const Vector& velocity) const {
  const NodeMatrix<dim>& stiffness = forces_.stiffness;
  const Nodes v = nodes_.space.with_ghosts(velocity), x = reached(dt, v);
  const std::size_t n = nodes_.bodies.size();
  std::vector<double> sums(2 * n, 0);  // values, then round-off
  Nodes ignored(nodes_.space.n_local(), Point<dim>::Zero());
  for (std::size_t b = 0; b < n; ++b) {
    const double part = share(nodes_.bodies[b]);
    for (std::size_t k = 0; k < forces_.elements[b].size() && part > 0; ++k) {
      const double energy =
          forces_.elements[b][k]->add_elastic_forces(x, nodes_.n_owned(), ignored);
      sums[b] += forces_.softening[b] / part * energy;
    }
  }
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    const double part = share_at(i);
    if (part == 0)
      continue;
    const int b = nodes_.body_of[i];
    const Point<dim> stiff = part * dt * stiffness.row_times(i, v);
    sums[b] += dt * v[i].dot(forces_.elastic[i] - 0.5 * stiff);
    for (int k = stiffness.row_begin(i); k < stiffness.row_end(i); ++k) {
      const double length = (x[stiffness.column(k)] - x[i]).squaredNorm();
      sums[n + b] += stiffness.block(k).cwiseAbs().sum() * length / part;
    }
  }
  sum_all(nodes_.comm, sums.data(), static_cast<int>(sums.size()));
  std::vector<ComputedEnergy> energies;
  for (std::size_t b = 0; b < n; ++b)
    energies.push_back({sums[b], 4 * std::numeric_limits<double>::epsilon() * sums[n + b]});
  return energies;
}

template <int dim>
std::vector<Point<dim>> ImplicitForces<dim>::reached(double dt, const Nodes& velocity) const {
  Nodes x = before_ ? *before_ : nodes_.x;
  for (int i = 0; i < nodes_.space.n_local(); ++i)
    x[i] += share_at(i) * dt * velocity[i];
  for (std::size_t i = 0; i < beside_.size(); ++i)
    x[i] += beside_[i];
  return x;
}

template <int dim>
void ImplicitForces<dim>::assemble(const Nodes& x) {
  implicit_force_ = Teuchos::null;
  forces_.assemble(x);
}

template class ImplicitForces<2>;
template class ImplicitForces<3>;

}  // namespace lockstep
