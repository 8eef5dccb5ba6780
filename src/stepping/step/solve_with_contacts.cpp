// Contact as a part of the coupled solve.
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.hpp"
#include "coupling/solid_totals.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/triplet_matrix.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "stepping/step/coupled_solve.hpp"
#include "stepping/step/locked_motions.hpp"
#include "stepping/step/locked_response.hpp"
#include "stepping/step/secant_response.hpp"

namespace lockstep {

namespace {
/// Stiffness of held rows over that of the solids' own response [1]: at 1e4 to 1e6 as many solves
/// are needed; from 1e8 on round-off tells.
constexpr double stiffness_factor = 1e5;
/// Velocity by which solve and contact model may differ, over that which gravity and impacts ask
/// for [1].
constexpr double tolerance = 1e-5;
/// Velocity by which they may differ where one more solve has gained nothing, over that, too [1]:
/// without it rag-doll takes a sixth more solves, mixed-solids a tenth more seconds.
constexpr double fair_tolerance = 1e-4;
/// Velocity by which they may differ beside closed fluid, over that which gravity gives in the step
/// and contacts have before it [1]. Chosen, not varied by a page.
constexpr double coarse_tolerance = 1e-3;
constexpr int most_solves = 12, most_without_gain = 5;
/// Part of their response without closed fluid that the contact model sees of rigid solids along
/// what that locks [1]. Contact bears there what it would without that fluid; at 0 the share of
/// both is round-off, from 1e-3 on heaps do not always come to rest.
constexpr double yield = 1e-4;

/// J^T K J on the map of the stack. Collective.
RCP<const CrsMatrix> stiffness_matrix(const std::vector<HeldRow>& rows, const RCP<const Map>& map) {
  std::vector<Triplet> triplets;
  for (const HeldRow& row : rows)
    for (const auto& [dof, weight] : row.weights)
      if (map->isNodeGlobalElement(dof))
        for (const auto& [other, other_weight] : row.weights)
          triplets.push_back({dof, other, row.stiffness * weight * other_weight});
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

/// Impulses that held rows have given in a solve: l~ = l - K (J V - b). Collective.
std::vector<double> impulses_of(const std::vector<HeldRow>& rows, const Vector& velocity,
                                const Communicator& comm) {
  std::vector<double> impulses = values_of(rows, velocity, comm);
  for (std::size_t k = 0; k < rows.size(); ++k)
    impulses[k] = rows[k].impulse - rows[k].stiffness * (impulses[k] - rows[k].velocity);
  return impulses;
}

/// Puts the impulses J^T l~ of the contacts of a solve into their report, and what of them are
/// limits'. Collective.
template <int dim>
void report_impulses(const std::vector<double>& impulses, const SolidSystem<dim>& solids,
                     ContactReport<dim>& contacts) {
  const auto impulse = make_vector(solids.map()), on_given = make_vector(solids.map());
  add_to(contacts.sliding, 1, *impulse);
  add_to(contacts.sliding_on_given, 1, *on_given);
  contacts.limit_impulses.clear();
  for (std::size_t k = 0; k < impulses.size(); ++k) {
    const HeldRow& row = contacts.held[k];
    add_to(row.weights, impulses[k], *impulse);
    add_to(row.on_given, impulses[k], *on_given);
    for (const auto& [dof, weight] : row.weights)
      if (row.is_limit)
        contacts.limit_impulses.emplace_back(dof, impulses[k] * weight);
  }
  for (PrescribedPush<dim>& push : contacts.on_prescribed)
    if (push.row != PrescribedPush<dim>::whole) {
      push.impulse.for_each_part([&](auto& part) { part *= impulses[push.row]; });
      push.row = PrescribedPush<dim>::whole;
    }
  contacts.impulse = impulse;
  contacts.impulse_on_given = on_given;
  contacts.external_impulse = solids.momentum(*impulse);
  contacts.reactions = Teuchos::null;  // the solve has them
}

/// Largest block of the mass of solids that joints tie together.
template <int dim>
int largest_block(const SolidSystem<dim>& solids) {
  return std::max(largest_dense_block, solids.joints()->largest_block());
}

RCP<Vector> difference(const Vector& a, const Vector& b) {
  const auto result = rcp(new Vector(a, Teuchos::Copy));
  result->update(-1, b, 1);
  return result;
}

/// A row by the unknowns, on the ranks that own them. Collective.
template <int dim>
std::vector<std::pair<GlobalIndex, double>> by_unknowns(
    const SolidSystem<dim>& solids, const std::vector<std::pair<GlobalIndex, double>>& weights) {
  if (!solids.reduction().has_combinations())
    return weights;
  Vector row(solids.map());
  add_to(weights, 1, row);
  solids.reduction().restrict(row);
  std::vector<std::pair<GlobalIndex, double>> result;
  const auto values = row.getData();
  for (int local = 0; local < values.size(); ++local)
    if (values[local] != 0)
      result.emplace_back(row.getMap()->getGlobalElement(local), values[local]);
  return result;
}

RCP<const Vector> on_unknowns(const Reduction& constraints, const RCP<Vector>& impulse) {
  constraints.restrict(*impulse);
  return impulse;
}

template <int dim>
ContactPhase phase_of(const StepContext<dim>& context) {
  return context.moves_positions ? ContactPhase::position : ContactPhase::velocity;
}

/// The mass that R has beside M_S: of the fluid on solids, as a matrix on the stack.
template <int dim>
RCP<const CrsMatrix> mass_of_fluid_near(const Components<dim>& components) {
  const RCP<const CrsMatrix> lumped = components.coupling->added_mass();
  if (const auto* coupling = components.coupling->hydrostatics())
    return coupling->mass_with_fluid(*components.solids, lumped);
  return lumped;
}

/// Lets no stiffness be so large beside a light body's own mass that the round-off of K J V reaches
/// the tolerance of the solve in the directions that are free.
template <int dim>
void soften(const Components<dim>& components, double tolerance_of_solve, double dt,
            std::vector<HeldRow>& rows) {
  if (rows.empty())
    return;
  constexpr double round_off = 10 * std::numeric_limits<double>::epsilon();
  const auto& solids = *components.solids;
  const RCP<const Vector> mobility = inverse_diagonal(
      *assembled(solids.solid_block(components.coupling->added_mass(), dt)), "solids in contact");
  const auto of_dofs = mobility->getData();
  std::vector<double> own(rows.size(), 0);
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const auto& [dof, weight] : by_unknowns(solids, rows[k].weights))
      if (const int local = mobility->getMap()->getLocalElement(dof); local >= 0)
        own[k] += weight * weight * of_dofs[local];
  sum_over_ranks(solids.comm(), own);
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k].stiffness = std::min(rows[k].stiffness, tolerance_of_solve / (round_off * own[k]));
}

/// True if closed fluid locks rigid solids. Of soft ones it ties all nodes to one another, and
/// leaves them other ways to go.
template <int dim>
bool locks_rigid_solids(const Components<dim>& components, const CoupledSystem<dim>& system) {
  return system.locks_solids() && !has_soft_solids(*components.solids);
}

/// P C^-1 P^T, velocities of all dofs from impulses on them. Collective, and so is every
/// application.
RCP<const LinearOperator> on_all_dofs(const Reduction& constraints, const RCP<const Map>& map,
                                      const RCP<const LinearOperator>& inverse) {
  if (constraints.is_identity())
    return inverse;
  return action_operator(map, [=](const Vector& impulse, Vector& velocity) {
    Vector reduced(impulse, Teuchos::Copy);
    constraints.restrict(reduced);
    apply(*inverse, reduced, velocity);
    constraints.expand_change(velocity);
  });
}

/// Motions that closed fluid does not let rigid solids make. Collective.
template <int dim>
LockedMotions locked_motions(const Components<dim>& components, const CoupledSystem<dim>& system,
                             const StepContext<dim>& context) {
  const auto& solids = *components.solids;
  const auto block = solids.solid_block(components.coupling->added_mass(), context.dt);
  return {
      system.pressure_null_space(), system.locked_directions(),
      system.locked_rates(context.constraints),
      on_all_dofs(context.constraints, solids.map(), exact_inverse(block, "solids in contact"))};
}

/// The impulses of rows by the contact model, with the opposite sign.
std::vector<double> opposite_impulses(const std::vector<HeldRow>& rows) {
  std::vector<double> impulses;
  for (const HeldRow& row : rows)
    impulses.push_back(-row.impulse);
  return impulses;
}

/// Returns the unknowns at which a solve begins, to change: `nearby`, else those of the last step.
template <int dim>
BlockVector begin_of_solve(const Components<dim>& components, const StepContext<dim>& context,
                           const BlockVector* nearby) {
  BlockVector begin;
  if (nearby)
    return {rcp(new Vector(*nearby->pressure, Teuchos::Copy)), nearby->solid};
  begin.pressure =
      rcp(new Vector(*last_pressure(*components.fluid, context.step, context.dt), Teuchos::Copy));
  begin.solid = components.solids->velocity();
  return begin;
}

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

/// The velocity that gravity gives in a step, or that rows have before it if that is larger [m/s].
/// Collective.
template <int dim>
double ordinary_velocity(const Components<dim>& components, const StepContext<dim>& context,
                         const std::vector<HeldRow>& rows) {
  const auto& solids = *components.solids;
  return std::max(context.dt * components.fluid->gravity().norm(),
                  largest(values_of(rows, *solids.velocity(), solids.comm())));
}

/// Bound of `largest_change` over the ordinary velocity: what a body can bear of all others, and a
/// margin that was chosen. Contradictions went beyond it a hundred times.
template <int dim>
double most_change(const Components<dim>& components) {
  return 3.0 * (1 + static_cast<double>(components.solids->solids().size()));
}

/// The largest velocity that the impulse of a row would give it alone [m/s].
double largest_change(const std::vector<HeldRow>& rows) {
  double most = 0;
  for (const HeldRow& row : rows)
    most = std::max(most, std::abs(row.impulse) * row.response);
  return most;
}

}  // namespace

template <int dim>
bool CoupledSolve<dim>::holds_contacts() const {
  return components_.contact && components_.solids->has_unknowns();
}

template <int dim>
MotionWithContacts<dim> CoupledSolve<dim>::converge_with_contacts(const StepContext<dim>& context,
                                                                  const RCP<Vector>& momentum,
                                                                  const BlockVector* nearby) {
  MotionWithContacts<dim> motion = solve_with_contacts(context, momentum, nearby);
  for (int n_solves = 1; improve(context, n_solves, motion.solution, *momentum); ++n_solves) {
    MotionWithContacts<dim> next =
        solve_with_contacts(context, momentum, &motion.solution.unknowns);
    next.solution.report.add_work(motion.solution.report);
    motion = next;
  }
  return motion;
}

template <int dim>
ContactResponse CoupledSolve<dim>::contact_response(double dt) const {
  return [this, dt, response = RCP<const LinearOperator>()]() mutable {
    if (response.is_null()) {
      const auto& solids = *components_.solids;
      const std::string name = "solids in contact with the fluid on them";
      const auto block = solids.solid_block(mass_of_fluid_near(components_), dt);
      // A mechanism is one block, as the contact model has its mass.
      response =
          solids.joints()
              ? as_operator(
                    block_diagonal_inverse(assembled(block), largest_block(solids), name).inverse)
              : exact_inverse(block, name);
      response = locked_response(response, system_.locked_directions(),
                                 has_soft_solids(solids) ? 0 : yield);
    }
    return response;
  };
}

template <int dim>
ContactReport<dim> CoupledSolve<dim>::decide(const StepContext<dim>& context,
                                             const ContactResponse& response, Vector& velocity) {
  ScopedStage stage(timers_, "contact");
  constexpr double round_off = 1e-9;
  const Vector before(velocity, Teuchos::Copy);
  ContactReport<dim> report = components_.contact->decide(*components_.solids, phase_of(context),
                                                          context.step.dt, velocity, response);
  check_solve(report.n_contacts == 0 || !report.held.empty() || !report.sliding.empty() ||
                  difference(velocity, before)->norm2() <= round_off * before.norm2(),
              "The contact model \"{}\" pushes at {} contacts and returns no rows that the coupled "
              "solve could hold (`ContactReport::held`): the next solve would undo what it did.",
              components_.contact->name(), report.n_contacts);
  for (HeldRow& row : report.held)
    row.stiffness = stiffness_factor / row.response;
  soften(components_, options_.tolerance, context.dt, report.held);
  return report;
}

/// Impulse that changes the present velocities of the solids in a solve without contact: `momentum`
/// and that of the fluid, less what they have. The fluid's is for rigid solids that of fluid at
/// rest, known from the first step on. On the nodes of soft ones that is right in sum alone, so
/// that they have the pressure of the last step: what lies still takes one solve a phase in place
/// of eight.
template <int dim>
RCP<Vector> CoupledSolve<dim>::expected_impulse(const StepContext<dim>& context,
                                                const Vector& momentum,
                                                const Vector& velocity) const {
  const auto& solids = *components_.solids;
  const bool by_rest = !has_soft_solids(*components_.solids) || context.step.last_dt == 0;
  RCP<Vector> given;
  if (by_rest) {
    given = rcp(new Vector(momentum, Teuchos::Copy));
    given->update(1, *impulse_at_rest(components_, context.dt), 1);
  } else {
    given = system_.lumped_momentum(momentum);
    components_.coupling->coupling_transposed()->apply(
        *last_pressure(*components_.fluid, context.step, context.dt), *given, Teuchos::NO_TRANS, -1,
        1);
  }
  const RCP<const CrsMatrix> lumped = by_rest ? Teuchos::null : components_.coupling->added_mass();
  apply(*solids.full_block(lumped, context.dt), velocity, *given, -1, 1);
  return given;
}

template <int dim>
ContactReport<dim> CoupledSolve<dim>::expected_contacts(const StepContext<dim>& context,
                                                        const Vector& momentum,
                                                        const ContactResponse& response) {
  const auto& solids = *components_.solids;
  Vector velocity(*solids.velocity(), Teuchos::Copy), given(momentum, Teuchos::Copy);
  given.update(1, *impulse_at_rest(components_, context.dt), 1);
  // R of soft solids and mechanisms is dear: it is not made where nothing is near.
  if (!components_.contact->may_act(solids, phase_of(context), context.step.dt,
                                    *solids.velocity_of(given)))
    return {};
  const RCP<Vector> change = expected_impulse(context, momentum, velocity);
  context.constraints.restrict(*change);
  apply(*response(), *change, velocity, 1, 1);
  context.constraints.expand(velocity);
  return decide(context, response, velocity);
}

template <int dim>
void CoupledSolve<dim>::hold(const ContactReport<dim>& contacts, Vector& momentum) {
  system_.hold(contacts.held.empty() ? RCP<const CrsMatrix>()
                                     : stiffness_matrix(contacts.held, components_.solids->map()));
  add_to(contacts.sliding, 1, momentum);
  for (const HeldRow& row : contacts.held)
    add_to(row.weights, row.impulse + row.stiffness * row.velocity, momentum);
}

/// Velocities from row 2 without K, C V = q + J^T l~ - B^T p: its round-off is K times larger, and
/// momentum would be off by that.
template <int dim>
void CoupledSolve<dim>::release(const StepContext<dim>& context, MotionWithContacts<dim>& motion) {
  system_.hold(Teuchos::null);
  if (motion.contact.held.empty())
    return;
  CoupledSolution& solution = motion.solution;
  const BlockSystem& blocks = system_.blocks(context.dt);
  const RCP<Vector> row = system_.lumped_momentum(*solution.momentum);
  system_.subtract_given(context.dt, context.constraints, *row);
  if (!solution.gas_momentum.is_null())
    row->update(1, *solution.gas_momentum, 1);
  context.constraints.restrict(*row);
  blocks.coupling_transposed()->apply(*solution.unknowns.pressure, *row, Teuchos::NO_TRANS, -1, 1);
  const auto unknowns = make_vector(components_.solids->map());
  apply(*exact_inverse(blocks.solid_block(), "solids in contact"), *row, *unknowns);
  solution.unknowns.solid = unknowns;
  solution.velocity = rcp(new Vector(*unknowns, Teuchos::Copy));
  context.constraints.expand(*solution.velocity);
}

/// A solve that holds the contacts of `motion`, and the impulses that they give in it. `nearby`:
/// with the pressures of what is locked, as the solution has them.
template <int dim>
void CoupledSolve<dim>::solve_held(const StepContext<dim>& context, const Vector& momentum,
                                   const BlockVector* nearby, const LockedMotions& locked,
                                   MotionWithContacts<dim>& motion) {
  const auto& solids = *components_.solids;
  const auto pushed = rcp(new Vector(momentum, Teuchos::Copy));
  ContactReport<dim> free = motion.contact;
  const Eigen::MatrixXd levels = locked.take_out(free.held);
  // A row that is near to what fluid locks is a small difference: its round-off is larger.
  if (levels.size() > 0)
    soften(components_, 0.1 * options_.tolerance, context.dt, free.held);
  hold(free, *pushed);
  BlockVector begin;
  if (levels.size() > 0) {
    begin = begin_of_solve(components_, context, nearby);
    locked.add_pressure(levels, opposite_impulses(free.held), *begin.pressure);
    nearby = &begin;
  }
  motion.solution = solve(context, pushed, context.solve, nearby);
  const std::vector<double> impulses =
      impulses_of(free.held, *motion.solution.velocity, solids.comm());
  locked.add_pressure(levels, impulses, *motion.solution.unknowns.pressure);
  report_impulses(impulses, solids, motion.contact);
  motion.solution.momentum = rcp(new Vector(momentum, Teuchos::Copy));
  motion.solution.momentum->update(1, *motion.contact.impulse, 1);
}

/// Decides anew about V - R^-1 J^T l~, and returns the contacts found. The residual of `motion`
/// becomes the velocity at contacts by which both differ, over `scale`: that which gravity and
/// contacts ask for, both in m/s.
template <int dim>
ContactReport<dim> CoupledSolve<dim>::compare(const StepContext<dim>& context,
                                              const ContactResponse& response,
                                              MotionWithContacts<dim>& motion, double& scale) {
  const auto free = rcp(new Vector(*motion.solution.velocity, Teuchos::Copy));
  if (!motion.contact.held.empty()) {
    Vector reduced(*motion.contact.impulse, Teuchos::Copy);
    context.constraints.restrict(reduced);
    apply(*response(), reduced, *free, -1, 1);
    context.constraints.expand(*free);
  }
  motion.free_velocity = free;
  Vector decided(*free, Teuchos::Copy);
  ContactReport<dim> next = decide(context, response, decided);
  const RCP<const Vector> stopped = difference(decided, *free);
  decided.update(-1, *motion.solution.velocity, 1);
  const auto& comm = components_.solids->comm();
  motion.contact.residual = std::max(largest(values_of(motion.contact.held, decided, comm)),
                                     largest(values_of(next.held, decided, comm)));
  scale = std::max(context.dt * components_.fluid->gravity().norm(),
                   largest(values_of(next.held, *stopped, comm)));
  return next;
}

/// In turn the contact model decides, in the response R of the solids with the fluid on them, which
/// contacts push and with what impulses l+, and a solve holds those,
///
///   (C + J^T K J) V + B^T p = q + J^T (l + K b),   l~ = l - K (J V - b).
///
/// Then C V + B^T p = q + J^T l~ exactly. The first decision is about what the solve gives in
/// fluid at rest, so that what lies takes one solve. They agree when l+ for the velocity V - R^-1
/// J^T l~ is l~. Contacts that bounce in one decision and not in the next may never agree: the best
/// of the last solves counts. What closed fluid and contacts ask for of rigid solids may
/// contradict; then impulses have no bound, and the motion is not settled.
template <int dim>
MotionWithContacts<dim> CoupledSolve<dim>::solve_with_contacts(const StepContext<dim>& context,
                                                               const RCP<const Vector>& momentum,
                                                               const BlockVector* nearby) {
  std::optional<SecantResponse> learned;
  const ContactResponse response = [&, first = contact_response(context.dt)]() {
    if (!learned)
      learned.emplace(first());
    return learned->current();
  };
  MotionWithContacts<dim> held, best;
  held.contact = expected_contacts(context, *momentum, response);
  const double ordinary = ordinary_velocity(components_, context, held.contact.held);
  const bool is_locked = locks_rigid_solids(components_, system_);
  LockedMotions locked;
  SolveReport replaced;  // work of solves that others replace
  RCP<const Vector> last_impulse, last_velocity;
  int n_solves = 0, last_gain = 1;
  while (!is_locked ||
         largest_change(held.contact.held) <= most_change<dim>(components_) * ordinary) {
    if (locked.empty() && is_locked && !held.contact.held.empty())
      locked = locked_motions(components_, system_, context);
    try {
      solve_held(context, *momentum, n_solves > 0 ? &best.solution.unknowns : nearby, locked, held);
    } catch (const SolveError&) {
      if (!is_locked)
        throw;
      break;
    }
    ++n_solves;
    if (n_solves > 1 && learned)
      learned->learn(
          *on_unknowns(context.constraints, difference(*held.contact.impulse, *last_impulse)),
          *difference(*held.solution.unknowns.solid, *last_velocity));
    last_impulse = held.contact.impulse;
    last_velocity = held.solution.unknowns.solid;
    double scale = 0;
    ContactReport<dim> next = compare(context, response, held, scale);
    if (n_solves == 1 || held.contact.residual < 0.5 * best.contact.residual)
      last_gain = n_solves;
    if (n_solves == 1 || held.contact.residual < best.contact.residual)
      std::swap(best, held);
    if (n_solves > 1)
      replaced.add_work(held.solution.report);
    const bool is_fair = best.contact.residual <= fair_tolerance * scale;
    if (best.contact.residual <= tolerance * scale || n_solves == most_solves ||
        n_solves - last_gain == (is_fair ? 1 : most_without_gain))
      break;
    held.contact = std::move(next);
  }
  best.is_settled =
      !is_locked || (n_solves > 0 && best.contact.residual <= coarse_tolerance * ordinary);
  best.contact.n_solves = best.contact.held.empty() ? 0 : n_solves;
  best.solution.report.add_work(replaced);
  release(context, best);
  return best;
}

template <int dim>
RCP<Vector> CoupledSolve<dim>::reactions_to_contacts(const StepContext<dim>& context,
                                                     const MotionWithContacts<dim>& motion) const {
  const auto& solids = *components_.solids;
  const auto reactions = rcp(new Vector(*motion.contact.impulse, Teuchos::Copy));
  apply(*solids.full_block(mass_of_fluid_near(components_), context.dt),
        *difference(*motion.solution.velocity, *motion.free_velocity), *reactions, 1, -1);
  context.constraints.keep_reactions(*reactions);
  return reactions;
}

template bool CoupledSolve<2>::holds_contacts() const;
template bool CoupledSolve<3>::holds_contacts() const;
template MotionWithContacts<2> CoupledSolve<2>::converge_with_contacts(const StepContext<2>&,
                                                                       const RCP<Vector>&,
                                                                       const BlockVector*);
template MotionWithContacts<3> CoupledSolve<3>::converge_with_contacts(const StepContext<3>&,
                                                                       const RCP<Vector>&,
                                                                       const BlockVector*);
template RCP<Vector> CoupledSolve<2>::expected_impulse(const StepContext<2>&, const Vector&,
                                                       const Vector&) const;
template RCP<Vector> CoupledSolve<3>::expected_impulse(const StepContext<3>&, const Vector&,
                                                       const Vector&) const;
template ContactResponse CoupledSolve<2>::contact_response(double) const;
template ContactResponse CoupledSolve<3>::contact_response(double) const;
template ContactReport<2> CoupledSolve<2>::expected_contacts(const StepContext<2>&, const Vector&,
                                                             const ContactResponse&);
template ContactReport<3> CoupledSolve<3>::expected_contacts(const StepContext<3>&, const Vector&,
                                                             const ContactResponse&);
template void CoupledSolve<2>::hold(const ContactReport<2>&, Vector&);
template void CoupledSolve<3>::hold(const ContactReport<3>&, Vector&);
template MotionWithContacts<2> CoupledSolve<2>::solve_with_contacts(const StepContext<2>&,
                                                                    const RCP<const Vector>&,
                                                                    const BlockVector*);
template MotionWithContacts<3> CoupledSolve<3>::solve_with_contacts(const StepContext<3>&,
                                                                    const RCP<const Vector>&,
                                                                    const BlockVector*);
template RCP<Vector> CoupledSolve<2>::reactions_to_contacts(const StepContext<2>&,
                                                            const MotionWithContacts<2>&) const;
template RCP<Vector> CoupledSolve<3>::reactions_to_contacts(const StepContext<3>&,
                                                            const MotionWithContacts<3>&) const;

}  // namespace lockstep
