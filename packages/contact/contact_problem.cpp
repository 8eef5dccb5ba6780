#include "contact/contact_problem.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
constexpr int most_rounds = 12;
constexpr int most_searches = 3;
/// Contacts of a pair that become active at once: enough to hold a face.
template <int dim>
constexpr int most_at_once = dim == 2 ? 2 : 4;
}  // namespace

template <int dim>
ContactProblem<dim>::ContactProblem(const SolidSystem<dim>& system,
                                    const ContactShapes<dim>& shapes,
                                    const std::vector<HalfSpace>& walls,
                                    const GaussSeidelOptions& options, double spacing,
                                    ContactPhase phase, double dt)
    : system_(system),
      shapes_(shapes),
      walls_(walls),
      options_(options),
      spacing_(spacing),
      phase_(phase),
      dt_(dt) {}

template <int dim>
ContactReach ContactProblem<dim>::reach(double speed) const {
  ContactReach reach;
  reach.swept = phase_ == ContactPhase::position;
  reach.near = spacing_ * std::max(options_.slop, options_.margin) +
               std::min(dt_ * speed, 2 * options_.margin * spacing_);
  reach.depth = spacing_ * options_.deepest;
  reach.half_thickness = 0.5 * options_.shell_thickness * spacing_;
  reach.dt = dt_;
  return reach;
}

template <int dim>
double ContactProblem<dim>::normal_velocity(const SolidMotion<dim>& motion,
                                            const Contact<dim>& contact) const {
  Point<dim> velocity = motion.at(contact.solid, contact.point, contact.x);
  if (contact.other >= 0)
    velocity -= motion.at(contact.other, contact.other_point, contact.x);
  return contact.normal.dot(velocity);
}

template <int dim>
double ContactProblem<dim>::friction(const Contact<dim>& contact) const {
  const double one = shapes_.solids()[contact.solid].friction;
  const double other = contact.other >= 0 ? shapes_.solids()[contact.other].friction
                                          : options_.wall_friction.value_or(one);
  return std::sqrt(one * other);
}

template <int dim>
double ContactProblem<dim>::restitution(const Contact<dim>& contact) const {
  const double one = shapes_.solids()[contact.solid].restitution;
  const double other = contact.other >= 0 ? shapes_.solids()[contact.other].restitution
                                          : options_.wall_restitution.value_or(one);
  return std::sqrt(one * other);
}

template <int dim>
double ContactProblem<dim>::target(const Contact<dim>& contact, double normal_velocity,
                                   double before) const {
  const double slop = options_.slop * spacing_;
  const double free = -std::max(contact.gap, 0.0) / dt_;
  if (phase_ == ContactPhase::position) {
    if (contact.gap >= -slop)
      return free;
    return std::min(options_.push_rate * (-contact.gap - slop), 0.25 * spacing_) / dt_;
  }
  // Forces of this step alone, as those on a resting body, do not bounce.
  const double closing = std::min(-normal_velocity, -before);
  if (normal_velocity < free && closing > options_.bounce_speed)
    return std::max(free, restitution(contact) * closing);
  return free;
}

template <int dim>
void ContactProblem<dim>::add_candidates(const SolidMotion<dim>& motion,
                                         const SolidMotion<dim>& before) {
  double speed = 0;
  for (int i = 0; i < shapes_.n_solids(); ++i) {
    if (!motion.range(i).isEmpty()) {
      speed = std::max({speed, motion.range(i).min().cwiseAbs().maxCoeff(),
                        motion.range(i).max().cwiseAbs().maxCoeff()});
    }
  }
  for (Contact<dim>& contact : find_contacts(shapes_, motion, walls_, reach(speed))) {
    std::vector<int>& pair = pairs_[{contact.solid, contact.other}];
    const bool known = std::any_of(pair.begin(), pair.end(), [&](int k) {
      const Contact<dim>& one = candidates_[k].contact;
      return one.point.position == contact.point.position &&
             one.normal.dot(contact.normal) > 1 - 1e-9;
    });
    if (known)
      continue;
    Candidate candidate;
    candidate.target =
        target(contact, normal_velocity(motion, contact), normal_velocity(before, contact));
    candidate.contact = std::move(contact);
    pair.push_back(static_cast<int>(candidates_.size()));
    candidates_.push_back(std::move(candidate));
  }
  searched_.clear();
  for (int i = 0; i < shapes_.n_solids(); ++i)
    searched_.push_back(motion.range(i));
}

template <int dim>
bool ContactProblem<dim>::prepare(const std::vector<double>& before,
                                  const std::vector<double>& velocity) {
  before_ = before;
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  add_candidates(motion, SolidMotion<dim>(system_, shapes_, before));
  for (const Candidate& candidate : candidates_) {
    scale_ = std::max(scale_, candidate.target - normal_velocity(motion, candidate.contact));
  }
  return scale_ > 0;
}

template <int dim>
void ContactProblem<dim>::activate(Candidate& candidate, ImpulseSolver<dim>& solver) const {
  candidate.active = true;
  solver.add(candidate.contact, candidate.target, friction(candidate.contact));
}

template <int dim>
int ContactProblem<dim>::activate_violated(const SolidMotion<dim>& motion, int most,
                                           double tolerance, ImpulseSolver<dim>& solver) {
  int n_activated = 0;
  for (auto& [pair, members] : pairs_) {
    std::vector<std::pair<double, int>> violated;
    for (int k : members) {
      const Candidate& candidate = candidates_[k];
      const double lack = candidate.target - normal_velocity(motion, candidate.contact);
      if (!candidate.active && lack > tolerance)
        violated.push_back({lack, k});
    }
    std::vector<Point<dim>> chosen;
    for (int n = 0; n < most; ++n) {
      double best = 0;
      int next = -1;
      for (const auto& [lack, k] : violated) {
        double distance = 1e300;
        for (const Point<dim>& x : chosen)
          distance = std::min(distance, (candidates_[k].contact.x - x).norm());
        const double value = chosen.empty() ? lack : lack * distance;
        if (!candidates_[k].active && value > best * (1 + 1e-9)) {
          best = value;
          next = k;
        }
      }
      if (next < 0)
        break;
      chosen.push_back(candidates_[next].contact.x);
      activate(candidates_[next], solver);
      ++n_activated;
    }
  }
  return n_activated;
}

template <int dim>
void ContactProblem<dim>::extend_search(const std::vector<double>& velocity) {
  const SolidMotion<dim> motion(system_, shapes_, velocity);
  const double allowed = 0.5 * options_.margin * spacing_ / dt_;
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
    add_candidates(motion, SolidMotion<dim>(system_, shapes_, before_));
}

template <int dim>
int ContactProblem<dim>::solve(ImpulseSolver<dim>& solver) {
  int sweeps = 0, searches = 1;
  for (int round = 0; round < most_rounds; ++round) {
    const SolidMotion<dim> motion(system_, shapes_, solver.velocity());
    const double tolerance = (round == 0 ? 0 : 10) * options_.tolerance * scale_;
    const int most = round == 0 ? most_at_once<dim> : 2;
    if (activate_violated(motion, most, tolerance, solver) == 0)
      break;
    sweeps += solver.iterate(std::max(1, options_.sweeps / 8), options_.tolerance * scale_);
    if (phase_ == ContactPhase::position && searches < most_searches) {
      const std::size_t known = candidates_.size();
      extend_search(solver.velocity());
      searches += candidates_.size() > known ? 1 : 0;
    }
  }
  return sweeps + solver.iterate(options_.sweeps, options_.tolerance * scale_);
}

template <int dim>
double ContactProblem<dim>::deepest_overlap() const {
  double deepest = 0;
  for (const Candidate& candidate : candidates_)
    deepest = std::max(deepest, -candidate.contact.gap);
  return deepest;
}

template class ContactProblem<2>;
template class ContactProblem<3>;

}  // namespace lockstep
