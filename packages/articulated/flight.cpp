#include "articulated/flight.hpp"

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

  /// Of a body, with its present momentum [rad/s].
  double fastest_turn() const {
    double fastest = 0;
    for (const int body : problem_.mechanism.bodies) {
      const TwistVector<dim> velocity = masses_[body].inverse * motions_[body].momentum;
      fastest = std::max(fastest, velocity.template tail<n_rotations<dim>>().norm());
    }
    return fastest;
  }

  /// False if the joints do not close. Momenta are then those after the impulse at its begin.
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
      coordinates_[j] =
          lockstep::coordinates(joint.kind, place_of(joint, poses_).pose, coordinates_[j]);
    }
    return true;
  }

  /// At its present place.
  void hold() { let_joints_hold(part_of(0), motions_); }

  const std::vector<BodyMotion<dim>>& motions() const { return motions_; }

  Flight<dim> flight(const std::vector<BodyMotion<dim>>& start,
                     const std::vector<BodyMotion<dim>>& first) const {
    Flight<dim> result{first, std::vector<TwistVector<dim>>(first.size(), TwistVector<dim>::Zero()),
                       coordinates_};
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
std::optional<Flight<dim>> fly(const ClosingProblem<dim>& problem, const FlightSteps& steps,
                               const std::vector<BodyMotion<dim>>& motions) {
  constexpr int most = 2000;
  constexpr double negligible = 1e-12;
  Flyer<dim> flyer(problem, motions);
  std::vector<BodyMotion<dim>> first;
  double left = problem.dt;
  for (int n = 0; n < most; ++n) {
    const double parts = std::max(
        {double(steps.least - n), 1.0, std::ceil(left * flyer.fastest_turn() / steps.longest)});
    const double dt = left / parts;
    if (!flyer.advance(dt))
      return std::nullopt;
    if (n == 0)
      first = flyer.motions();
    left -= dt;
    if (parts == 1 || left <= negligible * problem.dt)
      return flyer.flight(motions, first);
    flyer.hold();
  }
  return std::nullopt;
}

template std::optional<Flight<2>> fly(const ClosingProblem<2>&, const FlightSteps&,
                                      const std::vector<BodyMotion<2>>&);
template std::optional<Flight<3>> fly(const ClosingProblem<3>&, const FlightSteps&,
                                      const std::vector<BodyMotion<3>>&);

}  // namespace lockstep
