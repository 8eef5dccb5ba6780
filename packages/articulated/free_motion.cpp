#include "articulated/free_motion.hpp"

#include <algorithm>
#include <cmath>

#include "motion/free_rotation.hpp"

namespace lockstep {

namespace {

/// A mechanism on its way.
template <int dim>
class Flyer {
 public:
  Flyer(const ClosingProblem<dim>& problem, std::vector<BodyMotion<dim>> motions)
      : problem_(problem),
        poses_(problem.poses),
        masses_(problem.masses),
        motions_(std::move(motions)),
        turned_(problem.poses.size(), AngularVector<dim>::Zero()) {
    for (const Joint<dim>& joint : problem.joints)
      coordinates_.push_back(joint.q);
  }

  /// In how many parts of a time, with present momenta, no body turns by more than `longest` [rad].
  /// The error of the energy goes with the square of the turn: a body that has hardly any of it may
  /// turn farther, as far as joints are sure to close.
  double n_parts(double time, double longest) const {
    constexpr double farthest = 0.5;     // rad
    constexpr double negligible = 0.01;  // part of the energy [1]
    const TwistVector<dim> constraint_error = mean_velocity();
    std::vector<double> energies, turns;
    double sum = 0;
    for (const int body : problem_.mechanism.bodies) {
      const TwistVector<dim> velocity =
          masses_[body].inverse * motions_[body].momentum - constraint_error;
      energies.push_back(velocity.dot(masses_[body].matrix * velocity));
      turns.push_back(time * velocity.template tail<n_rotations<dim>>().norm());
      sum += energies.back();
    }
    double n = 1;
    for (std::size_t b = 0; b < turns.size(); ++b) {
      const double part = energies[b] > 0 ? sum / energies[b] : 1e300;
      const double longer =
          std::max(longest, std::min(farthest, longest * std::sqrt(negligible * part)));
      n = std::max(n, std::ceil(turns[b] / longer));
    }
    return n;
  }

  /// Moves the bodies over dt; returns false if the joints do not close. Momenta are then those
  /// after the impulse at its begin.
  bool advance(double dt) {
    const ClosingProblem<dim> part = part_of(dt);
    if (!close_joints(part, Answer::free, motions_))
      return false;
    std::vector<BodyPose<dim>> poses = poses_after(part, motions_);
    for (const int body : problem_.mechanism.bodies) {
      turned_[body] += dt * motions_[body].twist.template tail<n_rotations<dim>>();
      turn_mass(poses[body].rotation * poses_[body].rotation.transpose(), masses_[body]);
    }
    poses_ = std::move(poses);
    for (const int j : problem_.mechanism.joints) {
      const Joint<dim>& joint = problem_.joints[j];
      coordinates_[j] = joint.kind->coordinates(place_of(joint, poses_).pose, coordinates_[j]);
    }
    return true;
  }

  /// Makes the joints hold at the present place.
  void hold() { let_joints_hold(part_of(0), motions_); }

  const std::vector<BodyMotion<dim>>& motions() const { return motions_; }

  FreeMotion<dim> free_motion(const std::vector<BodyMotion<dim>>& start,
                              const std::vector<BodyMotion<dim>>& first) const {
    FreeMotion<dim> result{
        first, std::vector<TwistVector<dim>>(first.size(), TwistVector<dim>::Zero()), coordinates_};
    for (const int body : problem_.mechanism.bodies) {
      const Axes<dim> turn = poses_[body].rotation * problem_.poses[body].rotation.transpose();
      const AngularVector<dim> vector =
          nearest_turn<dim>(rotation_vector<dim>(Orientation<dim>(turn)), turned_[body]);
      result.motions[body].twist << (poses_[body].position - problem_.poses[body].position), vector;
      result.motions[body].twist /= problem_.dt;
      result.given[body] = motions_[body].momentum - start[body].momentum;
    }
    return result;
  }

 private:
  /// Mean velocity of all bodies together, which do not turn as one.
  TwistVector<dim> mean_velocity() const {
    TwistVector<dim> mean = TwistVector<dim>::Zero();
    double mass = 0;
    for (const int body : problem_.mechanism.bodies) {
      mean.template head<dim>() += motions_[body].momentum.template head<dim>();
      mass += masses_[body].matrix(0, 0);
    }
    return mass > 0 ? TwistVector<dim>(mean / mass) : mean;
  }

  ClosingProblem<dim> part_of(double dt) const {
    return {problem_.mechanism, problem_.joints, poses_, problem_.ends, masses_, dt};
  }

  static void turn_mass(const Axes<dim>& turn, BodyMass<dim>& mass) {
    if constexpr (dim == 3) {
      for (auto* matrix : {&mass.matrix, &mass.inverse}) {
        auto inertia = matrix->template bottomRightCorner<3, 3>();
        const Eigen::Matrix3d turned = turn * inertia * turn.transpose();
        inertia = 0.5 * (turned + turned.transpose());  // symmetric without round-off
      }
    }
  }

  const ClosingProblem<dim>& problem_;
  std::vector<BodyPose<dim>> poses_;
  std::vector<BodyMass<dim>> masses_;
  std::vector<BodyMotion<dim>> motions_;
  std::vector<AngularVector<dim>> turned_;  ///< by body [rad]
  std::vector<Eigen::VectorXd> coordinates_;
};

}  // namespace

template <int dim>
std::optional<FreeMotion<dim>> fly(const ClosingProblem<dim>& problem, const FreeMotionSteps& steps,
                                   const std::vector<BodyMotion<dim>>& motions) {
  constexpr int most = 2000;
  constexpr double negligible = 1e-12, shortest = 1e-6;  // parts of the step [1]
  Flyer<dim> flyer(problem, motions);
  std::vector<BodyMotion<dim>> first;
  double left = problem.dt;
  for (int n = 0; n < most; ++n) {
    double dt = left / std::max(double(steps.least - n), flyer.n_parts(left, steps.longest));
    // A light body between others may be flung round faster than it turns as yet.
    while (!flyer.advance(dt)) {
      dt /= 2;
      if (steps.least == 1 || dt < shortest * problem.dt)
        return std::nullopt;
    }
    if (first.empty())
      first = flyer.motions();
    left -= dt;
    if (left <= negligible * problem.dt)
      return flyer.free_motion(motions, first);
    flyer.hold();
  }
  return std::nullopt;
}

template std::optional<FreeMotion<2>> fly(const ClosingProblem<2>&, const FreeMotionSteps&,
                                          const std::vector<BodyMotion<2>>&);
template std::optional<FreeMotion<3>> fly(const ClosingProblem<3>&, const FreeMotionSteps&,
                                          const std::vector<BodyMotion<3>>&);

}  // namespace lockstep
