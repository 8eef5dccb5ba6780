// Closing of joints: changes the motion of bodies so that their joints stay closed.
#include <fmt/format.h>

#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "articulated/articulation.hpp"
#include "articulated/lone_mechanism.hpp"
#include "base/errors.hpp"
#include "base/round_off.hpp"

namespace lockstep {

/// Sets the rates with which q goes to the end of a free_motion (see `advanced`).
template <int dim>
void JointConstraints<dim>::set_rates(const Mechanism& mechanism,
                                      const std::vector<Eigen::VectorXd>& coordinates, double dt,
                                      Vector& velocity) const {
  const auto values = velocity.getDataNonConst();
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint<dim>& joint = articulation_->joints()[mechanism.joints[j]];
    const Eigen::VectorXd rates = joint.kind->change_to(joint.q, coordinates[j]) / dt;
    for (int k = 0; k < joint.q.size() && joint.first_rate >= 0; ++k) {
      const int row = velocity.getMap()->getLocalElement(articulation_->dofs().first_rate +
                                                         joint.first_rate + k);
      if (row >= 0)
        values[row] = rates[k];
    }
  }
}

namespace {

/// Throws SolveError if motors and prescribed bodies lead a loop where it cannot be closed: of
/// short steps they alone do.
template <int dim>
void check_closed(const ClosingProblem<dim>& problem, const std::vector<BodyMotion<dim>>& motions) {
  constexpr double open = 1e-3;  // rad, of the mechanism's reach
  const Mechanism& mechanism = problem.mechanism;
  const auto is_given = [&](int j) { return problem.joints[j].control.any_given(); };
  if (mechanism.grounds.empty() &&
      std::none_of(mechanism.joints.begin(), mechanism.joints.end(), is_given))
    return;
  const std::vector<BodyPose<dim>> poses = poses_after(problem, motions);
  const double unit = reach(mechanism, problem.joints);
  for (const int j : mechanism.loops) {
    const double gap = largest_gap(problem.joints[j], poses, unit);
    std::vector<std::string> names;
    for (const int k : loop_of(mechanism, problem.joints, j))
      names.push_back("\"" + problem.joints[k].name + "\"");
    check_solve(gap <= open,
                "The joints {} form a loop that cannot close: a gap of {:.2g} m is left, or of an "
                "angle as many rad; check where their motors and prescribed solids lead.",
                fmt::join(names, ", "), largest_gap(problem.joints[j], poses));
  }
}

template <int dim>
double largest_turn(const ClosingProblem<dim>& problem,
                    const std::vector<BodyMotion<dim>>& motions) {
  double turn = 0;
  for (const int body : problem.mechanism.bodies)
    turn =
        std::max(turn, problem.dt * motions[body].twist.template tail<n_rotations<dim>>().norm());
  return turn;
}

/// True if the two sets of twists take a mechanism's bodies to different places.
template <int dim>
bool differ(const ClosingProblem<dim>& problem, const std::vector<BodyMotion<dim>>& motions,
            const std::vector<BodyMotion<dim>>& others) {
  constexpr double negligible =
      rounding::differences;  // part of the mechanism's reach [1]; angle [rad]
  const double unit = reach(problem.mechanism, problem.joints);
  return std::any_of(
      problem.mechanism.bodies.begin(), problem.mechanism.bodies.end(), [&](int body) {
        const TwistVector<dim> way = problem.dt * (motions[body].twist - others[body].twist);
        return way.template head<dim>().norm() > negligible * unit ||
               way.template tail<n_rotations<dim>>().norm() > negligible;
      });
}

}  // namespace

/// Nothing: bodies had better follow the rates of their joints.
template <int dim>
std::optional<FreeMotionSteps> JointConstraints<dim>::free_motion_steps(const Mechanism& mechanism,
                                                                        double turn,
                                                                        bool touched) const {
  constexpr double farthest_turn = 0.5;  // rad, where joints are closed in one part
  constexpr double finest_turn =
      0.1;  // largest turn of a part where nothing else is in the way [rad]
  constexpr int least = 4;
  constexpr double negligible =
      1e-3;  // negligible part of a body's mass [1]: fluid that it has to push
  const auto& bodies = articulation_->bodies();
  const auto& joints = articulation_->joints();
  const bool far = turn > farthest_turn;
  // Limits and contact acted on the motion as it would be straight on.
  const auto joint_is_free = [&](int j) {
    return !joints[j].control.any() && !(far && joints[j].limits.any());
  };
  const auto body_is_free = [&](int body) {
    return !bodies[body].carries_nodes && bodies[body].fluid_mass <= negligible * bodies[body].mass;
  };
  const bool alone = mechanism.grounds.empty() && !(far && touched) &&
                     std::all_of(mechanism.joints.begin(), mechanism.joints.end(), joint_is_free) &&
                     std::all_of(mechanism.bodies.begin(), mechanism.bodies.end(), body_is_free);
  if (alone)
    return FreeMotionSteps{least, finest_turn};
  if (!far)
    return FreeMotionSteps{};
  return std::nullopt;
}

/// Finds the free_motions of a mechanism; empty if joints could not be closed about the motions as
/// they were found, before contact and after it. `problem`: that of the mechanism alone.
template <int dim>
std::optional<typename JointConstraints<dim>::FoundFreeMotions> JointConstraints<dim>::free_motions(
    const Mechanism& mechanism, const ClosingProblem<dim>& problem,
    const std::vector<BodyMotion<dim>>& solved, const std::vector<BodyMotion<dim>>& motions) const {
  if (!articulation_->options().two_halves)
    return std::nullopt;
  const bool touched = differ(problem, solved, motions);
  const double turn = std::max(largest_turn(problem, solved), largest_turn(problem, motions));
  const std::optional<FreeMotionSteps> steps = free_motion_steps(mechanism, turn, touched);
  if (!steps)
    return std::nullopt;
  std::optional<FreeMotion<dim>> free = fly(problem, *steps, solved);
  if (!free || !touched)
    return free ? std::make_optional(FoundFreeMotions{*free, *free}) : std::nullopt;
  std::optional<FreeMotion<dim>> pushed = fly(problem, *steps, motions);
  return pushed ? std::make_optional(FoundFreeMotions{*free, *pushed}) : std::nullopt;
}

/// Bodies follow the rates of their joints; loops are closed if they can be.
template <int dim>
void JointConstraints<dim>::follow(const ClosingProblem<dim>& problem,
                                   const Eigen::VectorXd& change,
                                   std::vector<BodyMotion<dim>>& motions) const {
  constexpr double farthest_turn = 0.5;  // rad, where loops are sure to close
  const double turn = largest_turn(problem, motions);
  follow_rates(problem, change, motions);
  if (!problem.mechanism.loops.empty() && !close_joints(problem, Answer::straight, motions) &&
      turn <= farthest_turn)
    check_closed(problem, motions);
}

/// Velocity beside the terms of those bodies that are combinations, less the part that the root
/// carries along.
template <int dim>
RCP<Vector> JointConstraints<dim>::constraint_error(const std::vector<TwistVector<dim>>& change,
                                                    const RCP<const Map>& map) const {
  const RCP<Vector> result = make_vector(map);
  std::vector<TwistVector<dim>> own = change;
  const std::vector<MotionBasis<dim>> bases = articulation_->motion_bases();
  for (std::size_t m = 0; m < bases.size(); ++m) {
    const Mechanism& mechanism = articulation_->mechanisms()[m];
    if (mechanism.root == space)
      continue;
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b)
      own[mechanism.bodies[b]] -=
          bases[m].twists[b].leftCols(n_twist<dim>) * change[mechanism.root];
  }
  set_twists(own, *result);
  return result;
}

template <int dim>
typename JointConstraints<dim>::StepMotions JointConstraints<dim>::motions_of(
    const Vector& correction, const Vector& solved, const Vector& velocity) const {
  const auto& bodies = articulation_->bodies();
  const std::size_t n = bodies.size();
  StepMotions step;
  step.corrections = gather_twists(correction);
  step.masses.resize(n);
  step.solved.resize(n);
  step.motions.resize(n);
  step.later.assign(n, TwistVector<dim>::Zero());
  step.constraint_error.assign(n, TwistVector<dim>::Zero());
  const std::vector<TwistVector<dim>> before = gather_twists(solved), now = gather_twists(velocity);
  for (std::size_t b = 0; b < n; ++b) {
    if (bodies[b].prescribed())
      continue;
    step.masses[b] = mass_of<dim>(bodies[b].model->rigid_frame(bodies[b].solid).mass);
    const auto momentum = [&](const TwistVector<dim>& twist) -> TwistVector<dim> {
      return step.masses[b].matrix * twist - step.corrections[b];
    };
    step.solved[b] = {momentum(before[b]), before[b]};
    step.motions[b] = {momentum(now[b]), now[b]};
  }
  return step;
}

/// Impulses are those of the free_motion without contact, which S2 is to know nothing of.
template <int dim>
void JointConstraints<dim>::take(const Mechanism& mechanism, const FoundFreeMotions& found,
                                 StepMotions& step) const {
  for (std::size_t own = 0; own < mechanism.bodies.size(); ++own) {
    const int body = mechanism.bodies[own];
    const BodyMotion<dim>& free = found.free.motions[own];
    step.later[body] = found.free.given[own];
    step.corrections[body] = step.masses[body].matrix * free.twist - free.momentum;
    step.constraint_error[body] = free.twist - step.solved[body].twist;
    step.motions[body] = found.pushed.motions[own];
  }
}

/// 1 at the dofs of mechanisms whose joints were not closed. Null: there are none.
template <int dim>
RCP<Vector> JointConstraints<dim>::marks_at_end(const RCP<const Map>& map) const {
  const auto& joints = articulation_->joints();
  if (std::all_of(two_halves_.begin(), two_halves_.end(), [](char is) { return is != 0; }))
    return Teuchos::null;
  const RCP<Vector> marks = make_vector(map);
  const auto values = marks->getDataNonConst();
  const auto mark = [&](GlobalIndex first, Eigen::Index n) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const int row = map->getLocalElement(first + k);
      if (row >= 0)
        values[row] = 1;
    }
  };
  for (const Mechanism& mechanism : articulation_->mechanisms()) {
    if (two_halves_[mechanism.joints.front()] != 0)
      continue;
    for (const int body : mechanism.bodies)
      mark(articulation_->bodies()[body].first_dof, n_twist<dim>);
    for (const int j : mechanism.joints) {
      if (joints[j].first_rate >= 0)
        mark(articulation_->dofs().first_rate + joints[j].first_rate, joints[j].q.size());
    }
  }
  return marks;
}

template <int dim>
ClosedMotion JointConstraints<dim>::close(double time, double dt, const Vector& correction,
                                          const Vector& solved, Vector& velocity) {
  const Eigen::VectorXd change = dt * gather_rates(velocity);
  const std::vector<BodyPose<dim>> poses = articulation_->poses();
  const std::vector<BodyPose<dim>> ends = articulation_->prescribed_poses(time + dt);
  StepMotions step = motions_of(correction, solved, velocity);
  two_halves_.assign(articulation_->joints().size(), 0);
  bool any_closed = false;
  for (const Mechanism& mechanism : articulation_->mechanisms()) {
    const LoneMechanism<dim> lone = alone(mechanism, articulation_->joints());
    const std::vector<BodyPose<dim>> begins = lone.of_bodies(poses), goals = lone.of_bodies(ends);
    const std::vector<BodyMass<dim>> masses = lone.of_bodies(step.masses);
    const ClosingProblem<dim> problem{lone.mechanism, lone.joints, begins, goals, masses, dt};
    std::vector<BodyMotion<dim>> motions = lone.of_bodies(step.motions);
    const std::optional<FoundFreeMotions> found =
        free_motions(mechanism, problem, lone.of_bodies(step.solved), motions);
    if (!found) {
      follow(problem, change, motions);
      for (std::size_t own = 0; own < mechanism.bodies.size(); ++own)
        step.motions[mechanism.bodies[own]] = motions[own];
      continue;
    }
    take(mechanism, *found, step);
    set_rates(mechanism, found->pushed.coordinates, dt, velocity);
    for (const int j : mechanism.joints)
      two_halves_[j] = 1;
    any_closed = true;
  }
  std::vector<TwistVector<dim>> twists;
  for (const BodyMotion<dim>& motion : step.motions)
    twists.push_back(motion.twist);
  set_twists(twists, velocity);
  ClosedMotion motion;
  if (any_closed) {
    motion.constraint_error = constraint_error(step.constraint_error, velocity.getMap());
    motion.correction = rcp(new Vector(correction, Teuchos::Copy));
    set_twists(step.corrections, *motion.correction);
    motion.later_impulse = make_vector(velocity.getMap());
    set_twists(step.later, *motion.later_impulse);
    motion.at_end = marks_at_end(velocity.getMap());
  }
  return motion;
}

template ClosedMotion JointConstraints<2>::close(double, double, const Vector&, const Vector&,
                                                 Vector&);
template ClosedMotion JointConstraints<3>::close(double, double, const Vector&, const Vector&,
                                                 Vector&);

}  // namespace lockstep
