// How bodies move so that their joints stay closed.
#include <fmt/format.h>

#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "articulated/articulation.hpp"
#include "base/errors.hpp"

namespace lockstep {

/// So that q goes to the end of a flight. Those of balls are no rates of q.
template <int dim>
void JointConstraints<dim>::set_rates(const Mechanism& mechanism,
                                      const std::vector<Eigen::VectorXd>& coordinates, double dt,
                                      Vector& velocity) const {
  const auto values = velocity.getDataNonConst();
  for (const int j : mechanism.joints) {
    const Joint<dim>& joint = articulation_->joints()[j];
    for (int k = 0; k < joint.q.size() && joint.first_rate >= 0; ++k) {
      const int row = velocity.getMap()->getLocalElement(articulation_->dofs().first_rate +
                                                         joint.first_rate + k);
      if (row >= 0 && joint.kind.turn != JointTurn::any)
        values[row] = (coordinates[j][k] - joint.q[k]) / dt;
    }
  }
}

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

/// Nothing: bodies had better follow the rates of their joints.
template <int dim>
std::optional<FlightSteps> JointConstraints<dim>::flight_steps(const Mechanism& mechanism,
                                                               double turn, bool touched) const {
  constexpr double farthest_turn = 0.5;  // rad, where joints are closed in one part
  constexpr double finest_turn = 0.1;    // of a part, where nothing else is in the way
  constexpr int least = 4;
  constexpr double negligible = 1e-3;  // of a body's mass: what fluid it has to push
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
    return FlightSteps{least, finest_turn};
  if (!far)
    return FlightSteps{};
  return std::nullopt;
}

/// Empty: joints could not be closed about the motion as it was found.
template <int dim>
std::optional<Flight<dim>> JointConstraints<dim>::flight(
    const ClosingProblem<dim>& problem, const std::vector<BodyMotion<dim>>& motions,
    bool touched) const {
  if (!articulation_->options().two_halves)
    return std::nullopt;
  const std::optional<FlightSteps> steps =
      flight_steps(problem.mechanism, largest_turn(problem, motions), touched);
  return steps ? fly(problem, *steps, motions) : std::nullopt;
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

/// Those of the bodies that are combinations, less what the root's part of them carries along.
template <int dim>
RCP<Vector> JointConstraints<dim>::drift(const std::vector<TwistVector<dim>>& change,
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
ClosedMotion JointConstraints<dim>::close(double time, double dt, Vector& velocity) {
  return close_flight(time, dt, *make_vector(velocity.getMap()), false, velocity);
}

template <int dim>
ClosedFlight JointConstraints<dim>::close_flight(double time, double dt, const Vector& correction,
                                                 bool touched, Vector& velocity) {
  const auto& bodies = articulation_->bodies();
  const std::vector<TwistVector<dim>> before = gather_twists(velocity);
  std::vector<TwistVector<dim>> corrections = gather_twists(correction);
  std::vector<TwistVector<dim>> later(bodies.size(), TwistVector<dim>::Zero());
  const Eigen::VectorXd change = dt * gather_rates(velocity);
  const std::vector<BodyPose<dim>> poses = articulation_->poses();
  const std::vector<BodyPose<dim>> ends = articulation_->prescribed_poses(time + dt);
  std::vector<BodyMass<dim>> masses(bodies.size());
  std::vector<BodyMotion<dim>> motions(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (bodies[b].prescribed())
      continue;
    masses[b] = mass_of<dim>(bodies[b].model->rigid_frame(bodies[b].solid).mass);
    motions[b] = {masses[b].matrix * before[b] - corrections[b], before[b]};
  }
  bool closed = true;
  for (const Mechanism& mechanism : articulation_->mechanisms()) {
    const ClosingProblem<dim> problem{mechanism, articulation_->joints(), poses, ends, masses, dt};
    const std::optional<Flight<dim>> own = flight(problem, motions, touched);
    if (own) {
      set_rates(mechanism, own->coordinates, dt, velocity);
      for (const int body : mechanism.bodies) {
        motions[body] = own->motions[body];
        later[body] = own->given[body];
        corrections[body] = masses[body].matrix * motions[body].twist - motions[body].momentum;
      }
    } else {
      follow(problem, change, motions);
      closed = false;
    }
  }
  std::vector<TwistVector<dim>> twists(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    twists[b] = motions[b].twist;
  set_twists(twists, velocity);
  ClosedFlight motion;
  if (closed) {
    for (std::size_t b = 0; b < twists.size(); ++b)
      twists[b] -= before[b];
    motion.drift = drift(twists, velocity.getMap());
    motion.correction = rcp(new Vector(correction, Teuchos::Copy));
    set_twists(corrections, *motion.correction);
    motion.later_impulse = make_vector(velocity.getMap());
    set_twists(later, *motion.later_impulse);
  }
  return motion;
}

template ClosedMotion JointConstraints<2>::close(double, double, Vector&);
template ClosedFlight JointConstraints<2>::close_flight(double, double, const Vector&, bool,
                                                        Vector&);
template ClosedMotion JointConstraints<3>::close(double, double, Vector&);
template ClosedFlight JointConstraints<3>::close_flight(double, double, const Vector&, bool,
                                                        Vector&);

}  // namespace lockstep
