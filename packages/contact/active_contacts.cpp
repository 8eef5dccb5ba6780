// Active set of contacts and joint limits, found round by round.
#include <fmt/format.h>

#include <algorithm>

#include "base/errors.hpp"
#include "base/round_off.hpp"
#include "contact/contact_problem.hpp"

namespace lockstep {

namespace {
/// The load of a pile goes up by a solid a round, which may ask for more where it has been: so many
/// rounds beside one for each solid.
constexpr int further_rounds = 12;
constexpr int most_searches = 3;
constexpr int most_impact_rounds = 20;
/// Contacts of a pair that become active at once: enough to hold a face.
template <int dim>
constexpr int most_at_once = dim == 2 ? 2 : 4;
}  // namespace

template <int dim>
void ContactProblem<dim>::check_room(const Contact<dim>& contact) const {
  constexpr double most = 0.25;  // cells; a start may overlap by less
  if (phase_ != ContactPhase::position || -contact.gap <= most * spacing_)
    return;
  const auto name = [&](int solid) { return '"' + shapes_.solids()[solid].name + '"'; };
  const int side = ~contact.other;
  throw SolveError(fmt::format(
      "{} is driven {:.3g} m deep into {}, more than {} of a cell, and no contact can stop it: its "
      "motion, or that of joints that move it, is prescribed (\"Motion\" of solids, \"Control\" of "
      "joints). Give it room, a target that stops before, or a motor of limited torque.",
      name(contact.solid), -contact.gap,
      contact.other >= 0
          ? name(contact.other)
          : fmt::format("the side \"{} {}\"", "xyz"[side / 2], side % 2 == 0 ? "lower" : "upper"),
      most));
}

template <int dim>
void ContactProblem<dim>::leave_out_immovable(ImpulseSolver<dim>& solver) {
  const std::vector<double>& velocity = solver.velocity();
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  bool any = false;
  for (Candidate& candidate : candidates_) {
    const Contact<dim>& contact = candidate.contact;
    if (law_.any_bends(contact.solid, contact.other) && !system_.joints())
      continue;  // nodes that are held are no candidates
    const double speed = law_.normal_velocity(motion, contact);
    if (candidate.target > speed && !solver.can_move(contact)) {
      if (speed < 0 && (law_.is_given(contact.solid) || law_.is_given(contact.other)))
        check_room(contact);
      any = candidate.active = true;
    }
  }
  for (Limit& one : limits_) {
    if (one.target > one.value(velocity) && !solver.can_move(one.resolved))
      any = one.active = true;
  }
  if (any)
    find_scale(motion, velocity);
}

template <int dim>
bool ContactProblem<dim>::activate(Candidate& candidate, ImpulseSolver<dim>& solver) const {
  candidate.active = true;
  return solver.add(candidate.contact, candidate.target, law_.friction(candidate.contact));
}

template <int dim>
int ContactProblem<dim>::activate_violated(const SolidMotion<dim>& motion, int most,
                                           double tolerance, ImpulseSolver<dim>& solver) {
  int n_activated = 0;
  for (auto& [pair, members] : pairs_) {
    std::vector<std::pair<double, int>> violated;
    for (int k : members) {
      const Candidate& candidate = candidates_[k];
      const double lack = candidate.target - law_.normal_velocity(motion, candidate.contact);
      if (!candidate.active && lack > tolerance)
        violated.push_back({lack, k});
    }
    std::vector<Point<dim>> chosen;
    const bool all = law_.any_bends(pair.first, pair.second);
    for (const auto& [lack, k] : violated) {
      if (all && activate(candidates_[k], solver))
        ++n_activated;
    }
    for (int n = 0; n < most && !all;) {
      double best = 0;
      int next = -1;
      for (const auto& [lack, k] : violated) {
        double distance = 1e300;
        for (const Point<dim>& x : chosen)
          distance = std::min(distance, (candidates_[k].contact.x - x).norm());
        const double value = chosen.empty() ? lack : lack * distance;
        if (!candidates_[k].active && value > best * (1 + rounding::differences)) {
          best = value;
          next = k;
        }
      }
      if (next < 0)
        break;
      if (!activate(candidates_[next], solver))
        continue;
      chosen.push_back(candidates_[next].contact.x);
      ++n_activated;
      ++n;
    }
  }
  return n_activated;
}

template <int dim>
int ContactProblem<dim>::activate_limits(const std::vector<double>& velocity, double tolerance,
                                         ImpulseSolver<dim>& solver) {
  int n_activated = 0;
  for (Limit& one : limits_) {
    if (one.active || one.target - one.value(velocity) <= tolerance)
      continue;
    one.active = true;
    one.number = solver.add(one.resolved, one.target);
    n_activated += one.number >= 0 ? 1 : 0;
  }
  return n_activated;
}

template <int dim>
void ContactProblem<dim>::extend_search(const std::vector<double>& velocity) {
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  const double allowed = 0.5 * watched_gap * spacing_ / dt_;
  bool farther = false;
  for (int i = 0; i < shapes_.n_solids(); ++i) {
    if (motion.range(i).isEmpty())
      continue;
    Box<dim> known = searched_[i];
    known = Box<dim>(known.min().cwiseMin(0.0).array() - allowed,
                     known.max().cwiseMax(0.0).array() + allowed);
    farther = farther || !known.contains(motion.range(i));
  }
  if (farther)
    add_candidates(motion, SolidMotion<dim>(system_, shapes_, before_), false);
}

template <int dim>
int ContactProblem<dim>::sweep(ImpulseSolver<dim>& solver, int most) const {
  // In cells: limits of a loop may leave no play between them.
  constexpr double round_off = rounding::differences;
  const double tolerance = options_.tolerance * scale_;
  return solver.iterate(most, tolerance, std::max(tolerance, round_off * spacing_ / dt_));
}

template <int dim>
int ContactProblem<dim>::solve(ImpulseSolver<dim>& solver) {
  int sweeps = 0, searches = 1;
  if (system_.joints() || system_.reduction().has_given())
    leave_out_immovable(solver);
  if (scale_ == 0)
    return 0;
  for (const Contact<dim>& contact : held_)
    solver.add(contact, 0, 0);
  for (int round = 0; round < shapes_.n_solids() + further_rounds; ++round) {
    const SolidMotion<dim> motion(system_, shapes_, solver.velocity());
    const double tolerance = (round == 0 ? 0 : 10) * options_.tolerance * scale_;
    const int most = round == 0 ? most_at_once<dim> : 2;
    const int n_limits = activate_limits(solver.velocity(), tolerance, solver);
    if (activate_violated(motion, most, tolerance, solver) + n_limits == 0 &&
        (round > 0 || held_.empty()))
      break;
    sweeps += sweep(solver, std::max(1, options_.sweeps / 8));
    if (phase_ == ContactPhase::position && searches < most_searches) {
      const std::size_t known = candidates_.size();
      extend_search(solver.velocity());
      searches += candidates_.size() > known ? 1 : 0;
    }
  }
  sweeps += sweep(solver, options_.sweeps);
  return sweeps + stop_impacts(solver);
}

template <int dim>
bool ContactProblem<dim>::follows_impacts() const {
  const auto& solids = shapes_.solids();
  return phase_ == ContactPhase::position && !leaves_impacts_ &&
         std::any_of(solids.begin(), solids.end(),
                     [](const SolidDescription& solid) { return !solid.rigid; });
}

template <int dim>
std::vector<Contact<dim>> ContactProblem<dim>::impacts_of(
    const std::vector<double>& velocity) const {
  std::vector<Contact<dim>> contacts;
  if (!follows_impacts())
    return contacts;
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  SurfacePath<dim> path(shapes_, motion, dt_);
  path.unheld = unheld_;
  for (const FoundImpact<dim>& found : find_impacts(shapes_, path)) {
    const double apart = law_.clearance_between(found.pair.solid, found.pair.other);
    contacts.push_back(impact_contact(shapes_, motion, path, found, apart, dt_));
  }
  return contacts;
}

template <int dim>
int ContactProblem<dim>::stop_impacts(ImpulseSolver<dim>& solver) const {
  int sweeps = 0;
  for (int round = 0; round < most_impact_rounds; ++round) {
    const std::vector<Contact<dim>> impacts = impacts_of(solver.velocity());
    bool any = false;
    for (const Contact<dim>& contact : impacts)
      any = solver.add(contact, -contact.gap / dt_, law_.friction(contact)) || any;
    if (!any)
      break;
    sweeps += sweep(solver, options_.sweeps);
  }
  return sweeps;
}

template <int dim>
std::vector<HeldRow> ContactProblem<dim>::held_rows(const ImpulseSolver<dim>& solver) const {
  std::vector<HeldRow> held = solver.held_rows();
  for (const Limit& one : limits_) {
    const double impulse = one.number >= 0 ? solver.limit_impulse(one.number) : 0;
    if (impulse <= 0)
      continue;
    HeldRow row{one.limit.terms, one.target, impulse, solver.limit_response(one.number), true};
    solver.take_out_given(row);
    held.push_back(std::move(row));
  }
  return held;
}

template <int dim>
std::vector<std::pair<GlobalIndex, double>> ContactProblem<dim>::limit_impulses(
    const ImpulseSolver<dim>& solver) const {
  std::vector<std::pair<GlobalIndex, double>> all;
  for (const Limit& one : limits_) {
    const double impulse = one.number >= 0 ? solver.limit_impulse(one.number) : 0;
    for (const auto& [dof, weight] : one.limit.terms) {
      if (impulse != 0)
        all.emplace_back(dof, impulse * weight);
    }
  }
  return all;
}

template void ContactProblem<2>::leave_out_immovable(ImpulseSolver<2>&);
template std::vector<Contact<2>> ContactProblem<2>::impacts_of(const std::vector<double>&) const;
template bool ContactProblem<2>::follows_impacts() const;
template std::vector<HeldRow> ContactProblem<2>::held_rows(const ImpulseSolver<2>&) const;
template int ContactProblem<2>::solve(ImpulseSolver<2>&);
template std::vector<std::pair<GlobalIndex, double>> ContactProblem<2>::limit_impulses(
    const ImpulseSolver<2>&) const;
template void ContactProblem<3>::leave_out_immovable(ImpulseSolver<3>&);
template std::vector<Contact<3>> ContactProblem<3>::impacts_of(const std::vector<double>&) const;
template bool ContactProblem<3>::follows_impacts() const;
template std::vector<HeldRow> ContactProblem<3>::held_rows(const ImpulseSolver<3>&) const;
template int ContactProblem<3>::solve(ImpulseSolver<3>&);
template std::vector<std::pair<GlobalIndex, double>> ContactProblem<3>::limit_impulses(
    const ImpulseSolver<3>&) const;

}  // namespace lockstep
