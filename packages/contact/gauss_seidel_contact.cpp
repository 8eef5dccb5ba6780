#include "contact/gauss_seidel_contact.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "contact/contact_problem.hpp"
#include "contact/impacts/held_contacts.hpp"
#include "contact/impacts/impact_zones.hpp"

namespace lockstep {

namespace {

/// Generalized reactions of constraints while contact acted, of which later solves do not know: the
/// impulse that these solves know, `told`, less the impulse of contact. Null `told`: M_S dV.
/// Collective.
template <int dim>
RCP<const Vector> reactions_of(const SolidSystem<dim>& solids, const Vector& impulse,
                               const RCP<const Vector>& told, const Vector& change) {
  const auto reactions = rcp(new Vector(impulse, Teuchos::Copy));
  if (told.is_null())
    apply(*solids.mass(), change, *reactions, 1, -1);
  else
    reactions->update(1, *told, -1);
  solids.reduction().keep_reactions(*reactions);
  return reactions;
}

/// Options for decisions: a coupled solve compares its velocities with these to 1e-5 of what is
/// asked, and takes the more solves the less these are settled (a pile of 64 discs that falls into
/// water: 12.6 a step at the usual tolerance, 5.2 so). `soft`: the contacts may be many.
GaussSeidelOptions options_of_decisions(GaussSeidelOptions options, bool soft) {
  options.tolerance = std::min(options.tolerance, 1e-6);
  options.sweeps = std::max(options.sweeps, soft ? 1000 : 5000);
  return options;
}

/// Returns the velocities that combinations have beside their terms. Collective.
template <int dim>
RCP<Vector> constraint_error_of(const SolidSystem<dim>& solids, const Vector& velocity) {
  const auto constraint_error = rcp(new Vector(velocity, Teuchos::Copy));
  solids.reduction().follow(*constraint_error);
  constraint_error->update(1, velocity, -1);
  return constraint_error;
}

}  // namespace

template <int dim>
GaussSeidelContact<dim>::GaussSeidelContact(const GaussSeidelOptions& options,
                                            std::vector<HalfSpace> walls, double grid_spacing,
                                            WallVelocity<dim> wall_velocity)
    : options_(options),
      walls_(std::move(walls)),
      spacing_(grid_spacing),
      wall_velocity_(std::move(wall_velocity)) {}

template <int dim>
void GaussSeidelContact<dim>::begin_step(double time) {
  time_ = time;
  held_back_.clear();
  bouncing_.clear();
  dense_mobility_.reset();
}

/// Positions go by velocities in the middle of the step, velocities are those at its end.
template <int dim>
void GaussSeidelContact<dim>::move_walls(ContactPhase phase, double dt) {
  if (!wall_velocity_)
    return;
  const double time = time_ + (phase == ContactPhase::position ? 0.5 * dt : dt);
  for (HalfSpace& wall : walls_)
    wall.velocity.head<dim>() = wall_velocity_(wall.axis, wall.side % 2, time);
}

template <int dim>
const InverseMass& GaussSeidelContact<dim>::inverse_mass_of(const SolidSystem<dim>& solids) {
  const RCP<const LinearOperator> inverse = solids.mass_inverse();
  if (inverse != known_inverse_) {
    inverse_mass_ = replicated_inverse_mass(solids);
    known_inverse_ = inverse;
  }
  return inverse_mass_;
}

template <int dim>
const SolidPairs& GaussSeidelContact<dim>::apart_among(
    const std::vector<SolidDescription>& solids) {
  const bool are_known = std::equal(
      numbers_.begin(), numbers_.end(), solids.begin(), solids.end(),
      [](const std::string& name, const SolidDescription& solid) { return name == solid.name; });
  if (are_known || options_.apart.empty())
    return apart_;
  std::map<std::string, int> number_of;
  numbers_.clear();
  for (const SolidDescription& solid : solids) {
    number_of.emplace(solid.name, static_cast<int>(numbers_.size()));
    numbers_.push_back(solid.name);
  }
  apart_.clear();
  for (const auto& [one, other] : options_.apart) {
    const auto first = number_of.find(one), second = number_of.find(other);
    if (first == number_of.end() || second == number_of.end())
      continue;
    apart_.emplace(first->second, second->second);
    apart_.emplace(second->second, first->second);
  }
  return apart_;
}

/// Responses of dofs that contacts have asked for are kept from one decision to the next.
template <int dim>
Mobility<dim>& GaussSeidelContact<dim>::dense_mobility(const SolidSystem<dim>& solids,
                                                       const ContactResponse& response) {
  const RCP<const LinearOperator> inverse = response();
  if (!dense_mobility_ || dense_mobility_->response() != inverse)
    dense_mobility_ = std::make_unique<Mobility<dim>>(inverse_mass_of(solids), solids, inverse);
  return *dense_mobility_;
}

template <int dim>
typename GaussSeidelContact<dim>::Outcome GaussSeidelContact<dim>::act(
    const SolidSystem<dim>& solids, const Request& request, Vector& velocity) {
  const auto& [phase, dt, response, task] = request;
  const bool decides = task != Task::resolve;
  Outcome outcome;
  ContactReport<dim>& report = outcome.report;
  if (!solids.has_unknowns())
    return outcome;
  move_walls(phase, dt);
  ContactShapes<dim> shapes(solids, topology_);
  if (solids.joints())
    shapes.set_constraint_error(replicated(solids, *constraint_error_of(solids, velocity)));
  if (const RCP<const Vector> drift = solids.drift(); !drift.is_null())
    shapes.set_drift(replicated(solids, *drift));
  const auto bends = [](const SolidDescription& solid) {
    return !solid.rigid && !solid.prescribed;
  };
  const bool is_soft = std::any_of(shapes.solids().begin(), shapes.solids().end(), bends);
  const GaussSeidelOptions options = decides ? options_of_decisions(options_, is_soft) : options_;
  ContactProblem<dim> problem(solids, shapes,
                              {walls_, options, apart_among(solids.solids()), spacing_}, phase, dt);
  if (decides)
    problem.leave_impacts();
  if (task == Task::decide && phase == ContactPhase::velocity)
    problem.keep_bouncing(bouncing_);
  if (phase == ContactPhase::position)
    held_back_.clear();
  else
    problem.hold(held_contacts(shapes, held_back_));
  const std::vector<double> given = replicated(solids, velocity);
  bool& acted = acted_[phase == ContactPhase::position ? 0 : 1];
  const bool acts = problem.prepare(replicated(solids, *solids.velocity()), given, acted);
  acted = acts;
  outcome.acts = acts;
  if (!acts || task == Task::look)
    return outcome;
  report.deepest_overlap = problem.deepest_overlap();
  // The response of rigid solids and of nodes falls apart into blocks, as their masses do.
  const RCP<const CrsMatrix> blocks = decides ? assembled(response()) : RCP<const CrsMatrix>();
  const bool is_dense = response && blocks.is_null();
  const InverseMass of_blocks =
      blocks.is_null() ? InverseMass() : replicated_inverse(solids, *blocks);
  const InverseMass& inverse_mass = blocks.is_null() ? inverse_mass_of(solids) : of_blocks;
  Mobility<dim> of_rows(inverse_mass);
  Mobility<dim>& mobility = is_dense ? dense_mobility(solids, response) : of_rows;
  ImpulseSolver<dim> solver(solids, shapes, mobility, given);
  report.iterations = problem.solve(solver);
  report.n_contacts = solver.n_contacts();
  report.external_impulse = solver.external_impulse();
  report.limit_impulses = problem.limit_impulses(solver);

  const RCP<const Vector> impulse = distributed(solids, solver.generalized_impulse());
  const auto free = rcp(new Vector(*impulse, Teuchos::Copy));
  solids.reduction().drop_given(*free);
  if (solids.reduction().has_given()) {
    const auto on_given = rcp(new Vector(*impulse, Teuchos::Copy));
    on_given->update(-1, *free, 1);
    report.impulse_on_given = on_given;
  }
  report.on_prescribed = decides ? solver.held_pushes() : solver.pushes();
  if (response) {
    report.impulse = free;
    report.held = problem.held_rows(solver);
    report.sliding = solver.sliding_impulse(report.sliding_on_given);
  }
  std::vector<double> resolved = solver.velocity();
  if (phase == ContactPhase::position && !decides) {
    ZonedMotion<dim> zoned =
        join_impact_zones(solids, shapes, inverse_mass, dt, resolved, problem.unheld());
    report.n_crossings = zoned.n_left;
    held_back_ = std::move(zoned.held_back);
  }
  RCP<Vector> change = distributed(solids, resolved);
  if (is_dense) {
    // the change by impact zones, and all that the impulses move
    change->update(-1, *distributed(solids, solver.velocity()), 1);
    Vector reduced(*report.impulse, Teuchos::Copy);
    solids.reduction().restrict(reduced);
    apply(*mobility.response(), reduced, *change, 1, 1);
  } else {
    change->update(-1, *distributed(solids, given), 1);
    if (!inverse_mass.exact && phase == ContactPhase::velocity)
      change = solids.velocity_of(*impulse);
  }
  solids.reduction().follow(*change);
  if (solids.reduction().has_given() || solids.joints()) {
    report.reactions = reactions_of(solids, *impulse, report.impulse, *change);
    report.external_impulse += solids.momentum(*report.reactions);
  }
  velocity.update(1, *change, 1);
  return outcome;
}

template <int dim>
std::vector<HalfSpace> walls_of(const Box<dim>& domain,
                                const std::array<std::array<bool, 2>, dim>& closed_sides) {
  std::vector<HalfSpace> walls;
  for (int axis = 0; axis < dim; ++axis) {
    for (int upper = 0; upper < 2; ++upper) {
      if (closed_sides[axis][upper]) {
        walls.push_back({2 * axis + upper, axis, upper == 1 ? -1.0 : 1.0,
                         upper == 1 ? domain.max()[axis] : domain.min()[axis]});
      }
    }
  }
  return walls;
}

template class GaussSeidelContact<2>;
template class GaussSeidelContact<3>;
template std::vector<HalfSpace> walls_of<2>(const Box<2>&,
                                            const std::array<std::array<bool, 2>, 2>&);
template std::vector<HalfSpace> walls_of<3>(const Box<3>&,
                                            const std::array<std::array<bool, 2>, 3>&);

}  // namespace lockstep
