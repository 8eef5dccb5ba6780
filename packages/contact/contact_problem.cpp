#include "contact/contact_problem.hpp"

#include <algorithm>
#include <cmath>

#include "base/round_off.hpp"

namespace lockstep {

namespace {
/// Gap that surfaces keep between them where they would have met, and overlap of skins that is left
/// alone, both as a part of the sum of their half thicknesses [1].
constexpr double clearance = 0.25;
// Chosen so that a resting pile is quiet and overlaps stay small beside a cell; no page varies any
// of these. Lengths are in units of the grid spacing h.
/// Overlap that is left alone, and gap up to which solids count as touching.
constexpr double usual_slop = 0.05;
/// Overlap with a solid that is recognised.
constexpr double deepest = 0.5;
/// Part of an overlap beyond the slop that one step removes.
constexpr double push_out_rate = 0.2;
/// Turn of a step [rad] beyond which no linear function of the velocities is near the gap: then
/// places go along chords.
constexpr double longest_arc = 0.5;
/// No restitution below this speed of approach [m/s]: forces of a step alone do not bounce.
constexpr double least_bounce = 1e-3;

/// Hash of a place, the same for equal places.
template <int dim>
std::size_t hash_of(const Point<dim>& place) {
  std::size_t hash = 0;
  for (int a = 0; a < dim; ++a)
    hash = 1000003 * hash ^ std::hash<double>()(place[a]);
  return hash;
}

/// Shells and what deforms have a skin.
double half_thickness_of(const SolidDescription& solid, const GaussSeidelOptions& options,
                         double spacing) {
  const auto own = options.thickness_of.find(solid.name);
  if (own != options.thickness_of.end())
    return 0.5 * own->second;
  return solid.closed && solid.rigid ? 0 : 0.5 * options.thickness * spacing;
}
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
      dt_(dt) {
  for (const SolidDescription& solid : shapes.solids())
    half_thickness_.push_back(half_thickness_of(solid, options_, spacing_));
}

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
  reach.half_thickness = half_thickness_;
  reach.dt = dt_;
  return reach;
}

template <int dim>
double ContactProblem<dim>::normal_velocity(const SolidMotion<dim>& motion,
                                            const Contact<dim>& contact) const {
  Point<dim> velocity = motion.at(contact.solid, contact.point, contact.place());
  velocity -= contact.other >= 0
                  ? motion.at(contact.other, contact.other_point, contact.other_place())
                  : contact.wall_velocity;
  return contact.normal.dot(velocity);
}

template <int dim>
double ContactProblem<dim>::mean(const Contact<dim>& contact, double SolidDescription::*property,
                                 const std::optional<double>& of_walls) const {
  const double one = shapes_.solids()[contact.solid].*property;
  const double other =
      contact.other >= 0 ? shapes_.solids()[contact.other].*property : of_walls.value_or(one);
  return std::sqrt(one * other);
}

template <int dim>
double ContactProblem<dim>::friction(const Contact<dim>& contact) const {
  return mean(contact, &SolidDescription::friction, options_.wall_friction);
}

template <int dim>
bool ContactProblem<dim>::any_bends(const Pair& pair) const {
  const auto& solids = shapes_.solids();
  return !solids[pair.first].rigid || (pair.second >= 0 && !solids[pair.second].rigid);
}

template <int dim>
double ContactProblem<dim>::clearance_between(int solid, int other) const {
  return clearance * (half_thickness_[solid] + half_thickness_[other]);
}

/// Rigid bodies may overlap a little so that contacts stay; skins do the same without touching.
template <int dim>
double ContactProblem<dim>::slop(const Contact<dim>& contact) const {
  const double usual = usual_slop * spacing_;
  if (contact.other < 0 || !any_bends({contact.solid, contact.other}))
    return usual;
  return std::min(usual, clearance_between(contact.solid, contact.other));
}

template <int dim>
Point<dim> ContactProblem<dim>::turned_place(const SolidMotion<dim>& motion, int solid,
                                             const Point<dim>& x, const Point<dim>& normal) const {
  if (solid < 0 || !shapes_.solids()[solid].rigid)
    return x;
  const Point<dim> center = motion.center(solid), of_center = motion.at(solid, {}, center);
  const auto turn = [&](const Point<dim>& arm) {
    return Point<dim>(motion.at(solid, {}, center + arm) - of_center);
  };
  const double rate = motion.spin(solid).norm();
  const Point<dim> along = turn(x - center);
  const double closing = -normal.dot(along);
  if (rate == 0 || rate * dt_ > longest_arc || closing <= 0)
    return x;
  const double lowest = std::atan2(closing, normal.dot(turn(along)) / rate) / rate;
  const double duration = std::min(dt_, lowest);
  return motion.end_of_point(solid, x, duration) - duration * of_center;
}

template <int dim>
void ContactProblem<dim>::follow_turns(const SolidMotion<dim>& motion,
                                       Contact<dim>& contact) const {
  if (contact.impact)
    return;
  const Point<dim> x = contact.x, normal = contact.normal;
  const Point<dim> with_solid = turned_place(motion, contact.solid, x, normal);
  const Point<dim> with_other = turned_place(motion, contact.other, x, -normal);
  if (with_solid == x && with_other == x)
    return;
  // One place for both, or angular momentum would not be kept.
  if (is_given(contact.other))
    contact.x = with_solid;
  else
    contact.x = is_given(contact.solid) ? with_other : Point<dim>(0.5 * (with_solid + with_other));
  const auto turn = [&](int solid) {
    if (solid < 0 || !shapes_.solids()[solid].rigid)
      return Point<dim>(Point<dim>::Zero());
    return Point<dim>(motion.at(solid, {}, contact.x) - motion.at(solid, {}, motion.center(solid)));
  };
  contact.bend = normal.dot(with_solid - with_other) -
                 dt_ * normal.dot(turn(contact.solid) - turn(contact.other));
}

template <int dim>
double ContactProblem<dim>::target(const Contact<dim>& contact, const SolidMotion<dim>& motion,
                                   const SolidMotion<dim>& motion_before) const {
  const double normal_velocity = this->normal_velocity(motion, contact);
  const double before = this->normal_velocity(motion_before, contact);
  // No target is above zero where nothing overlaps, so that contact gives no energy.
  const double free = std::min(0., -(std::max(contact.gap, 0.0) + contact.bend) / dt_);
  if (phase_ == ContactPhase::position) {
    const double excess = -contact.gap - slop(contact);
    return excess <= 0 ? free : std::min(push_out_rate * excess, 0.25 * spacing_) / dt_;
  }
  // Forces of this step alone, as those on a resting body, do not bounce. What arrives exactly at
  // the end of the step does so in the next, whatever the round-off. A rigid body that does not
  // bounce at all goes on until it touches; a skin stops at once.
  const double closing = std::min(-normal_velocity, -before);
  const double restitution =
      mean(contact, &SolidDescription::restitution, options_.wall_restitution);
  const bool goes_on = restitution == 0 && !any_bends({contact.solid, contact.other});
  if (goes_on || -before <= least_bounce)
    return free;
  if (bouncing_ && bouncing_->count(bounce_key(contact)) > 0)
    return std::max(free, -before * restitution);
  if (closing <= least_bounce || normal_velocity >= free - rounding::differences * closing)
    return free;
  return std::max(free, (bouncing_ ? -before : closing) * restitution);
}

template <int dim>
std::size_t ContactProblem<dim>::bounce_key(const Contact<dim>& contact) const {
  const std::size_t pair = 65599 * static_cast<std::size_t>(contact.solid + 1) +
                           static_cast<std::size_t>(contact.other + 64);
  return hash_of<dim>(contact.point.position) ^ (pair << 20);
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
    follow_turns(before, contact);
    worst = std::max(worst, target(contact, motion, before) - normal_velocity(motion, contact));
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
    follow_turns(before, contact);
    Candidate candidate;
    candidate.target = target(contact, motion, before);
    if (bouncing_ && candidate.target > 0)
      bouncing_->insert(bounce_key(contact));
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
      largest = std::max(largest, candidate.target - normal_velocity(motion, candidate.contact));
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
    scale_ = std::max(scale_, -normal_velocity(motion, contact));
  if (scale_ > 0)
    return;
  for (const Contact<dim>& contact : impacts_of(velocity))
    scale_ = std::max(scale_, -contact.gap / dt_ - normal_velocity(motion, contact));
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
