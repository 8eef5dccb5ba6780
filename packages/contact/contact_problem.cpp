#include "contact/contact_problem.hpp"

#include <algorithm>
#include <cmath>

#include "base/round_off.hpp"

namespace lockstep {

namespace {
/// Overlap with a solid that is recognised [h]; chosen, not varied by a page.
constexpr double deepest = 0.5;

}  // namespace

template <int dim>
ContactProblem<dim>::ContactProblem(const SolidSystem<dim>& system,
                                    const ContactShapes<dim>& shapes,
                                    const ContactConditions& setting, ContactPhase phase, double dt)
    : system_(system),
      shapes_(shapes),
      walls_(setting.walls),
      options_(setting.options),
      apart_(setting.apart),
      spacing_(setting.spacing),
      phase_(phase),
      dt_(dt),
      law_(shapes, setting.options, setting.spacing, phase, dt) {}

template <int dim>
ContactReach ContactProblem<dim>::reach(const SolidMotion<dim>& motion) const {
  double speed = 0;
  for (int i = 0; i < shapes_.n_solids(); ++i) {
    if (!motion.range(i).isEmpty()) {
      speed = std::max({speed, motion.range(i).min().cwiseAbs().maxCoeff(),
                        motion.range(i).max().cwiseAbs().maxCoeff()});
    }
  }
  ContactReach reach;
  reach.swept = phase_ == ContactPhase::position;
  reach.near = spacing_ * std::max(usual_slop, watched_gap) +
               std::min(dt_ * speed, 2 * watched_gap * spacing_);
  reach.depth = spacing_ * deepest;
  reach.half_thickness = law_.half_thickness();
  reach.dt = dt_;
  return reach;
}

template <int dim>
bool ContactProblem<dim>::is_apart(const Contact<dim>& contact) const {
  if (contact.other < 0)
    return false;
  return apart_.count({shapes_.source(contact.solid), shapes_.source(contact.other)}) > 0 ||
         shapes_.hangs_on(contact.point, contact.other) ||
         shapes_.hangs_on(contact.other_point, contact.solid);
}

template <int dim>
bool ContactProblem<dim>::is_known(const Contact<dim>& contact) const {
  const auto found = by_place_.find(hash_of<dim>(contact.point.position));
  if (found == by_place_.end())
    return false;
  return std::any_of(found->second.begin(), found->second.end(), [&](int k) {
    const Contact<dim>& one = candidates_[k].contact;
    return one.solid == contact.solid && one.other == contact.other &&
           one.point.position == contact.point.position &&
           one.normal.dot(contact.normal) > 1 - rounding::differences;
  });
}

template <int dim>
double ContactProblem<dim>::worst_violation(const SolidMotion<dim>& motion,
                                            const SolidMotion<dim>& before) {
  ContactReach look = reach(motion);
  look.violated_only = true;
  double worst = 0;
  for (Contact<dim>& contact : find_contacts(shapes_, motion, walls_, look)) {
    if (is_apart(contact))
      continue;
    law_.follow_turns(before, contact);
    worst = std::max(worst, law_.target(contact, motion, before, bouncing_) -
                                law_.normal_velocity(motion, contact));
    deepest_ = std::max(deepest_, -contact.gap);
  }
  return worst;
}

template <int dim>
void ContactProblem<dim>::add_candidates(const SolidMotion<dim>& motion,
                                         const SolidMotion<dim>& before, bool unheld) {
  ContactReach look = reach(motion);
  look.unheld = unheld;
  for (Contact<dim>& contact : find_contacts(shapes_, motion, walls_, look)) {
    if (is_apart(contact) || is_known(contact))
      continue;
    law_.follow_turns(before, contact);
    Candidate candidate;
    candidate.target = law_.target(contact, motion, before, bouncing_);
    if (bouncing_ && candidate.target > 0)
      bouncing_->insert(law_.bounce_key(contact));
    candidate.contact = std::move(contact);
    const int number = static_cast<int>(candidates_.size());
    pairs_[{candidate.contact.solid, candidate.contact.other}].push_back(number);
    by_place_[hash_of<dim>(candidate.contact.point.position)].push_back(number);
    candidates_.push_back(std::move(candidate));
  }
  searched_.clear();
  for (int i = 0; i < shapes_.n_solids(); ++i)
    searched_.push_back(motion.range(i));
}

template <int dim>
bool ContactProblem<dim>::prepare(const std::vector<double>& before,
                                  const std::vector<double>& velocity, bool expected) {
  before_ = before;
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  const SolidMotion<dim> motion_before(system_, shapes_, before);
  if (follows_impacts())
    unheld_ = SurfacePath<dim>(shapes_, motion, dt_).after;
  bool is_searched = expected || worst_violation(motion, motion_before) > 0;
  if (is_searched)
    add_candidates(motion, motion_before);
  if (const ConstraintModel* joints = system_.joints()) {
    for (JointLimit& limit : joints->limits(dt_, velocity)) {
      // An excess over a limit is corrected in the positions, without a speed of its own.
      const double room = phase_ == ContactPhase::position ? limit.room : std::max(limit.room, 0.);
      auto resolved = shapes_.resolved(limit.terms);
      limits_.push_back({std::move(limit), std::move(resolved), -room / dt_});
    }
  }
  find_scale(motion, velocity);
  if (scale_ > 0 && !is_searched)
    add_candidates(motion, motion_before);
  return scale_ > 0;
}

template <int dim>
double ContactProblem<dim>::largest_violation(const SolidMotion<dim>& motion,
                                              const std::vector<double>& velocity) const {
  double largest = 0;
  for (const Candidate& candidate : candidates_) {
    if (!candidate.active)
      largest =
          std::max(largest, candidate.target - law_.normal_velocity(motion, candidate.contact));
  }
  for (const Limit& one : limits_) {
    if (!one.active)
      largest = std::max(largest, one.target - one.value(velocity));
  }
  return largest;
}

template <int dim>
void ContactProblem<dim>::find_scale(const SolidMotion<dim>& motion,
                                     const std::vector<double>& velocity) {
  scale_ = largest_violation(motion, velocity);
  for (const Contact<dim>& contact : held_)
    scale_ = std::max(scale_, -law_.normal_velocity(motion, contact));
  if (scale_ > 0)
    return;
  for (const Contact<dim>& contact : impacts_of(velocity))
    scale_ = std::max(scale_, -contact.gap / dt_ - law_.normal_velocity(motion, contact));
}

template <int dim>
double ContactProblem<dim>::deepest_overlap() const {
  double deepest = deepest_;
  for (const Candidate& candidate : candidates_)
    deepest = std::max(deepest, -candidate.contact.gap);
  return deepest;
}

template class ContactProblem<2>;
template class ContactProblem<3>;

}  // namespace lockstep
