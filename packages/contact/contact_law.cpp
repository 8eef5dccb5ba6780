#include "contact/contact_law.hpp"

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
/// Part of an overlap beyond the slop that one step removes.
constexpr double push_out_rate = 0.2;
/// Turn of a step [rad] beyond which no linear function of the velocities is near the gap: then
/// places go along chords.
constexpr double longest_arc = 0.5;
/// No restitution below this speed of approach [m/s]: forces of a step alone do not bounce.
constexpr double least_bounce = 1e-3;

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
ContactLaw<dim>::ContactLaw(const ContactShapes<dim>& shapes, const GaussSeidelOptions& options,
                            double spacing, ContactPhase phase, double dt)
    : shapes_(shapes), options_(options), spacing_(spacing), phase_(phase), dt_(dt) {
  for (const SolidDescription& solid : shapes.solids())
    half_thickness_.push_back(half_thickness_of(solid, options_, spacing_));
}

template <int dim>
std::size_t hash_of(const Point<dim>& place) {
  std::size_t hash = 0;
  for (int a = 0; a < dim; ++a)
    hash = 1000003 * hash ^ std::hash<double>()(place[a]);
  return hash;
}

template <int dim>
double ContactLaw<dim>::normal_velocity(const SolidMotion<dim>& motion,
                                        const Contact<dim>& contact) const {
  Point<dim> velocity = motion.at(contact.solid, contact.point, contact.place());
  velocity -= contact.other >= 0
                  ? motion.at(contact.other, contact.other_point, contact.other_place())
                  : contact.wall_velocity;
  return contact.normal.dot(velocity);
}

template <int dim>
double ContactLaw<dim>::mean(const Contact<dim>& contact, double SolidDescription::*property,
                             const std::optional<double>& of_walls) const {
  const double one = shapes_.solids()[contact.solid].*property;
  const double other =
      contact.other >= 0 ? shapes_.solids()[contact.other].*property : of_walls.value_or(one);
  return std::sqrt(one * other);
}

template <int dim>
double ContactLaw<dim>::friction(const Contact<dim>& contact) const {
  return mean(contact, &SolidDescription::friction, options_.wall_friction);
}

template <int dim>
bool ContactLaw<dim>::any_bends(int solid, int other) const {
  const auto& solids = shapes_.solids();
  return !solids[solid].rigid || (other >= 0 && !solids[other].rigid);
}

template <int dim>
bool ContactLaw<dim>::is_cloth(int solid) const {
  return solid >= 0 && !shapes_.solids()[solid].rigid && !shapes_.solids()[solid].closed;
}

template <int dim>
double ContactLaw<dim>::clearance_between(int solid, int other) const {
  return clearance * (half_thickness_[solid] + half_thickness_[other]);
}

/// Rigid bodies may overlap a little so that contacts stay; skins do the same without touching.
template <int dim>
double ContactLaw<dim>::slop(const Contact<dim>& contact) const {
  const double usual = usual_slop * spacing_;
  if (contact.other < 0 || !any_bends(contact.solid, contact.other))
    return usual;
  return std::min(usual, clearance_between(contact.solid, contact.other));
}

template <int dim>
Point<dim> ContactLaw<dim>::turned_place(const SolidMotion<dim>& motion, int solid,
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

/// A node that comes down along its arc to a gap of zero has 2 sqrt(gap * opening) to go along its
/// chord if it is lowest within the step, gap + opening if at its end.
template <int dim>
double ContactLaw<dim>::bend_of_drift(const Contact<dim>& contact) const {
  Point<dim> drift = shapes_.drift(contact.point, contact.x);
  if (contact.other >= 0)
    drift -= shapes_.drift(contact.other_point, contact.x);
  const double opening = dt_ * contact.normal.dot(drift), gap = std::max(contact.gap, 0.0);
  return gap < opening ? 2 * std::sqrt(gap * opening) - gap : opening;
}

template <int dim>
void ContactLaw<dim>::follow_turns(const SolidMotion<dim>& motion, Contact<dim>& contact) const {
  if (contact.impact)
    return;
  const Point<dim> x = contact.x, normal = contact.normal;
  const Point<dim> with_solid = turned_place(motion, contact.solid, x, normal);
  const Point<dim> with_other = turned_place(motion, contact.other, x, -normal);
  contact.bend = bend_of_drift(contact);
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
  contact.bend += normal.dot(with_solid - with_other) -
                  dt_ * normal.dot(turn(contact.solid) - turn(contact.other));
}

template <int dim>
double ContactLaw<dim>::target(const Contact<dim>& contact, const SolidMotion<dim>& motion,
                               const SolidMotion<dim>& motion_before,
                               const std::set<std::size_t>* bouncing) const {
  const double normal_velocity = this->normal_velocity(motion, contact);
  const double before = this->normal_velocity(motion_before, contact);
  // No target is above zero where nothing overlaps, so that contact gives no energy.
  const double free = std::min(0., -(std::max(contact.gap, 0.0) + contact.bend) / dt_);
  if (phase_ == ContactPhase::position) {
    const double excess = -contact.gap - slop(contact);
    return excess <= 0 ? free : std::min(push_out_rate * excess, 0.25 * spacing_) / dt_;
  }
  // Forces of this step alone, as those on a resting body, do not bounce. What arrives exactly at
  // the end of the step does so in the next, whatever the round-off. Bodies that do not bounce at
  // all go on until they touch; cloth stops at once.
  const double closing = std::min(-normal_velocity, -before);
  const double restitution =
      mean(contact, &SolidDescription::restitution, options_.wall_restitution);
  const bool goes_on = restitution == 0 && !is_cloth(contact.solid) && !is_cloth(contact.other);
  if (goes_on || -before <= least_bounce)
    return free;
  if (bouncing && bouncing->count(bounce_key(contact)) > 0)
    return std::max(free, -before * restitution);
  if (closing <= least_bounce || normal_velocity >= free - rounding::differences * closing)
    return free;
  return std::max(free, (bouncing ? -before : closing) * restitution);
}

template <int dim>
std::size_t ContactLaw<dim>::bounce_key(const Contact<dim>& contact) const {
  const std::size_t pair = 65599 * static_cast<std::size_t>(contact.solid + 1) +
                           static_cast<std::size_t>(contact.other + 64);
  return hash_of<dim>(contact.point.position) ^ (pair << 20);
}

template class ContactLaw<2>;
template class ContactLaw<3>;
template std::size_t hash_of<2>(const Point<2>&);
template std::size_t hash_of<3>(const Point<3>&);

}  // namespace lockstep
