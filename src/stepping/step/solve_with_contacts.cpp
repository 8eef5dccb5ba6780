// Contact as a part of the coupled solve.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "linear/triplet_matrix.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "stepping/step/coupled_solve.hpp"

namespace lockstep {

namespace {
/// Stiffness of held rows over that of the solids' own response [1]: at 1e4 to 1e6 as many solves
/// are needed; from 1e8 on round-off tells.
constexpr double stiffness_factor = 1e5;
/// Velocity by which solve and contact model may differ, over that which gravity and impacts ask
/// for [1].
constexpr double tolerance = 1e-5;
constexpr int most_solves = 10;

double stiffness_of(const HeldRow& row) {
  return stiffness_factor / row.response;
}

/// J^T K J on the map of the stack. Collective.
RCP<const CrsMatrix> stiffness_matrix(const std::vector<HeldRow>& rows, const RCP<const Map>& map) {
  std::vector<Triplet> triplets;
  for (const HeldRow& row : rows)
    for (const auto& [dof, weight] : row.weights)
      if (map->isNodeGlobalElement(dof))
        for (const auto& [other, other_weight] : row.weights)
          triplets.push_back({dof, other, stiffness_of(row) * weight * other_weight});
  return assemble_triplets(std::move(triplets), map, map);
}

/// Adds factor times weights to the dofs of this rank.
void add_to(const std::vector<std::pair<GlobalIndex, double>>& weights, double factor,
            Vector& impulse) {
  for (const auto& [dof, weight] : weights)
    if (impulse.getMap()->isNodeGlobalElement(dof))
      impulse.sumIntoGlobalValue(dof, factor * weight);
}

/// The sums of weights times velocities, of each row. Collective.
std::vector<double> values_of(const std::vector<HeldRow>& rows, const Vector& velocity,
                              const Communicator& comm) {
  std::vector<double> values(rows.size(), 0);
  const auto data = velocity.getData();
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const auto& [dof, weight] : rows[k].weights)
      if (const int local = velocity.getMap()->getLocalElement(dof); local >= 0)
        values[k] += weight * data[local];
  sum_all(comm, values.data(), static_cast<int>(values.size()));
  return values;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}
}  // namespace

template <int dim>
bool CoupledSolve<dim>::holds_contacts() const {
  const auto& solids = *components_.solids;
  const auto is_soft = [](const SolidDescription& solid) {
    return !solid.rigid && !solid.prescribed;
  };
  return components_.contact && solids.has_unknowns() && !solids.joints() &&
         std::none_of(solids.solids().begin(), solids.solids().end(), is_soft);
}

template <int dim>
RCP<Vector> CoupledSolve<dim>::impulse_at_rest(double dt) const {
  const auto impulse = make_vector(components_.solids->map());
  if (const auto* coupling = side_of<HydrostaticCoupling<dim>>(*components_.coupling))
    coupling->add_impulse_at_rest(dt, *impulse);
  return impulse;
}

/// In turn the contact model decides, in the response R of the solids with the fluid on them, which
/// contacts push and with what impulses l+, and a solve holds those,
///
///   (C + J^T K J) V + B^T p = q + J^T (l + K b),   l~ = l - K (J V - b),
///
/// so that C V + B^T p = q + J^T l~ exactly. The first decision is about what the solve gives in
/// fluid at rest, so that what lies takes one solve. They agree when l+ for the velocity V - R^-1
/// J^T l~ is l~.
template <int dim>
HeldSolve<dim> CoupledSolve<dim>::solve_with_contacts(const StepContext<dim>& context,
                                                      const RCP<const Vector>& momentum) {
  auto& solids = *components_.solids;
  const ContactPhase phase =
      context.moves_positions ? ContactPhase::position : ContactPhase::velocity;
  RCP<const LinearOperator> response;
  const ContactResponse respond = [&] {
    if (response.is_null()) {
      const auto* coupling = side_of<HydrostaticCoupling<dim>>(*components_.coupling);
      RCP<const CrsMatrix> with_fluid = components_.coupling->added_mass();
      if (coupling)
        with_fluid = coupling->mass_with_fluid(solids);
      response = exact_inverse(solids.solid_block(with_fluid, context.dt),
                               "solids in contact with the fluid on them");
    }
    return response;
  };
  const auto decide = [&](Vector& velocity) {
    ScopedStage stage(timers_, "contact");
    return components_.contact->resolve(solids, phase, context.step.dt, velocity, respond);
  };

  // V^n with what the solve would give at rest.
  Vector predicted(*solids.velocity(), Teuchos::Copy), given(*momentum, Teuchos::Copy);
  apply(*solids.mass(), predicted, given, -1, 1);
  given.update(1, *impulse_at_rest(context.dt), 1);
  context.constraints.restrict(given);
  apply(*respond(), given, predicted, 1, 1);
  context.constraints.expand(predicted);
  HeldSolve<dim> best;
  ContactReport<dim> decision = decide(predicted);
  for (int k = 1;; ++k) {
    HeldSolve<dim> held;
    held.n_solves = k;
    held.contact = decision;
    const auto pushed = rcp(new Vector(*momentum, Teuchos::Copy));
    const auto impulse = make_vector(solids.map());
    add_to(decision.sliding, 1, *impulse);
    pushed->update(1, *impulse, 1);
    for (const HeldRow& row : decision.held)
      add_to(row.weights, row.impulse + stiffness_of(row) * row.velocity, *pushed);
    system_.hold(decision.held.empty() ? Teuchos::null
                                       : stiffness_matrix(decision.held, solids.map()));
    held.solution =
        solve(context, pushed, context.solve, k > 1 ? &best.solution.unknowns : nullptr);
    const std::vector<double> values =
        values_of(decision.held, *held.solution.velocity, solids.comm());
    for (std::size_t r = 0; r < values.size(); ++r) {
      const HeldRow& row = decision.held[r];
      add_to(row.weights, row.impulse - stiffness_of(row) * (values[r] - row.velocity), *impulse);
    }
    held.solution.momentum = rcp(new Vector(*momentum, Teuchos::Copy));
    held.solution.momentum->update(1, *impulse, 1);
    held.contact.impulse = impulse;
    held.contact.external_impulse = solids.momentum(*impulse);

    Vector free(*held.solution.velocity, Teuchos::Copy), reduced(*impulse, Teuchos::Copy);
    context.constraints.restrict(reduced);
    apply(*respond(), reduced, free, -1, 1);
    context.constraints.expand(free);
    Vector decided(free, Teuchos::Copy);
    const ContactReport<dim> next = decide(decided);
    Vector difference(decided, Teuchos::Copy);
    difference.update(-1, *held.solution.velocity, 1);
    held.residual = std::max(largest(values_of(decision.held, difference, solids.comm())),
                             largest(values_of(next.held, difference, solids.comm())));
    Vector asked(decided, Teuchos::Copy);
    asked.update(-1, free, 1);
    const double scale = std::max(context.dt * components_.fluid->gravity().norm(),
                                  largest(values_of(next.held, asked, solids.comm())));
    if (k == 1 || held.residual < best.residual)
      best = held;
    if (held.residual <= tolerance * scale || k == most_solves) {
      best.n_solves = k;
      return best;
    }
    decision = next;
  }
}

template bool CoupledSolve<2>::holds_contacts() const;
template bool CoupledSolve<3>::holds_contacts() const;
template RCP<Vector> CoupledSolve<2>::impulse_at_rest(double) const;
template RCP<Vector> CoupledSolve<3>::impulse_at_rest(double) const;
template HeldSolve<2> CoupledSolve<2>::solve_with_contacts(const StepContext<2>&,
                                                           const RCP<const Vector>&);
template HeldSolve<3> CoupledSolve<3>::solve_with_contacts(const StepContext<3>&,
                                                           const RCP<const Vector>&);

}  // namespace lockstep
