#include "articulated/closing.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/round_off.hpp"
#include "linear/least_squares.hpp"
#include "motion/free_rotation.hpp"

namespace lockstep {

template <int dim>
BodyPose<dim> moved(const BodyPose<dim>& pose, const TwistVector<dim>& twist, double dt) {
  const AngularVector<dim> turn = dt * twist.template tail<n_rotations<dim>>();
  return {pose.position + dt * twist.template head<dim>(),
          rotation_of<dim>(turn).toRotationMatrix() * pose.rotation};
}

template <int dim>
TwistVector<dim> twist_to(const BodyPose<dim>& from, const BodyPose<dim>& to, double dt) {
  TwistVector<dim> twist;
  const Axes<dim> turn = to.rotation * from.rotation.transpose();
  twist << (to.position - from.position) / dt, rotation_vector<dim>(Orientation<dim>(turn)) / dt;
  return twist;
}

namespace {

/// Derivative of the rotation exp(turn) with respect to `turn` [rad]: exp(turn + d) = exp(result d)
/// exp(turn).
Eigen::Matrix<double, 1, 1> change_of_rotation(const AngularVector<2>&) {
  return Eigen::Matrix<double, 1, 1>::Identity();
}
Eigen::Matrix3d change_of_rotation(const AngularVector<3>& turn) {
  const double angle = turn.norm();
  Eigen::Matrix3d product;
  product << 0, -turn.z(), turn.y(), turn.z(), 0, -turn.x(), -turn.y(), turn.x(), 0;
  if (angle < 1e-4)
    return Eigen::Matrix3d::Identity() + 0.5 * product + product * product / 6;
  return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / (angle * angle) * product +
         (angle - std::sin(angle)) / (angle * angle * angle) * product * product;
}

/// The rows of all joints of a mechanism over the twists of its bodies.
template <int dim>
class Rows {
 public:
  explicit Rows(const ClosingProblem<dim>& problem) : problem_(problem) {
    column_.assign(problem.poses.size(), -1);
    for (const int body : problem.mechanism.bodies) {
      column_[body] = n_columns_;
      n_columns_ += n_twist<dim>;
    }
    for (const int j : problem.mechanism.joints) {
      n_rows_ +=
          static_cast<int>(problem.joints[j]
                               .kind->held_rows(place_of(problem.joints[j], problem.poses).pose)
                               .size());
      for (const CoordinateControl& control : problem.joints[j].control.coordinates)
        n_rows_ += control.given() ? 1 : 0;
    }
    unit_ = reach(problem.mechanism, problem.joints);
  }

  int n_columns() const { return n_columns_; }
  /// Round-off of gaps, for bodies as far away as they are; a slider may let go of a body without
  /// end.
  double round_off() const {
    double farthest = 0;
    for (const int body : problem_.mechanism.bodies)
      farthest = std::max(farthest, problem_.poses[body].position.norm());
    return 32 * std::numeric_limits<double>::epsilon() * farthest / unit_;
  }
  int column(int body) const { return column_[body]; }

  /// Rows and gaps; lengths count in `unit_`.
  void evaluate(const std::vector<BodyPose<dim>>& poses, Eigen::MatrixXd& rows,
                Eigen::VectorXd& gaps) const {
    rows.setZero(n_rows_, n_columns_);
    gaps.setZero(n_rows_);
    int row = 0;
    for (const int j : problem_.mechanism.joints) {
      const Joint<dim>& joint = problem_.joints[j];
      const JointPlace<dim> place = place_of(joint, poses);
      const std::vector<Screw<dim>> held = joint.kind->held_rows(place.pose);
      const Eigen::VectorXd open = joint.kind->gap(place.pose);
      for (std::size_t k = 0; k < held.size(); ++k)
        set(row++, held[k], open[k], {joint, place, poses}, rows, gaps);
      if (!joint.control.any_given())
        continue;
      const std::vector<Screw<dim>> rates = joint.kind->rate_rows(place.pose);
      const Eigen::VectorXd left = joint.kind->distance_to(place.pose, joint.goal.q);
      for (int k = 0; k < left.size(); ++k) {
        if (joint.control.given(k))
          set(row++, rates[k], -left[k], {joint, place, poses}, rows, gaps);
      }
    }
  }

 private:
  /// A joint where the poses of all bodies put it.
  struct PlacedJoint {
    const Joint<dim>& joint;
    const JointPlace<dim>& place;
    const std::vector<BodyPose<dim>>& poses;
  };
  void set(int row, const Screw<dim>& screw, double value, const PlacedJoint& placed,
           Eigen::MatrixXd& rows, Eigen::VectorXd& gaps) const {
    const double scale = screw.linear.isZero(0) ? 1 : 1 / unit_;
    gaps[row] = scale * value;
    for (int side = 0; side < 2; ++side) {
      const int body = placed.joint.sides[side].body;
      if (body != space && column_[body] >= 0)
        rows.block(row, column_[body], 1, n_twist<dim>) +=
            scale * row_on_side(screw, placed.place, side, placed.poses[body].position).transpose();
    }
  }

  const ClosingProblem<dim>& problem_;
  std::vector<int> column_;
  int n_rows_ = 0, n_columns_ = 0;
  double unit_ = 1;
};

/// J M^-1 J^T with each row scaled by how easily it is closed: bodies may be light and heavy.
template <int dim>
class Impulses {
 public:
  Impulses(const ClosingProblem<dim>& problem, const Rows<dim>& all, const Eigen::MatrixXd& rows)
      : problem_(problem), all_(all), impulses_(rows.transpose()), response_(impulses_) {
    for (const int body : problem.mechanism.bodies)
      response_.middleRows(all.column(body), n_twist<dim>) =
          problem.masses[body].inverse *
          rows.middleCols(all.column(body), n_twist<dim>).transpose();
    const Eigen::VectorXd ease = (rows * response_).diagonal();
    scale_ = (ease.array() > 0)
                 .select(ease.array().max(1e-300).rsqrt(), Eigen::ArrayXd::Zero(ease.size()));
    response_ *= scale_.asDiagonal();
    impulses_ *= scale_.asDiagonal();
  }

  /// Returns the smallest impulses on all bodies that change the values of `rows` by `values`.
  Eigen::VectorXd that_change(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values) const {
    constexpr double dependent = rounding::differences;
    return impulses_ * least_squares(scale_.asDiagonal() * rows * response_,
                                     scale_.cwiseProduct(values), dependent);
  }

  void give(const Eigen::VectorXd& impulses, double factor,
            std::vector<BodyMotion<dim>>& motions) const {
    for (const int body : problem_.mechanism.bodies)
      motions[body].momentum += factor * impulses.template segment<n_twist<dim>>(all_.column(body));
  }

 private:
  const ClosingProblem<dim>& problem_;
  const Rows<dim>& all_;
  Eigen::MatrixXd impulses_, response_;  ///< J^T, M^-1 J^T
  Eigen::VectorXd scale_;
};

/// Finds the twists of bodies whose momenta have changed since `before`.
template <int dim>
void find_twists(const ClosingProblem<dim>& problem, Answer answer,
                 const std::vector<BodyMotion<dim>>& before,
                 std::vector<BodyMotion<dim>>& motions) {
  for (const int body : problem.mechanism.bodies) {
    BodyMotion<dim>& one = motions[body];
    const BodyMass<dim>& mass = problem.masses[body];
    if (answer == Answer::free)
      one.twist = free_twist(mass, one.momentum, problem.dt);
    else
      one.twist = before[body].twist + mass.inverse * (one.momentum - before[body].momentum);
  }
}

}  // namespace

template <int dim>
BodyMass<dim> mass_of(const typename BodyMass<dim>::Matrix& matrix) {
  return {matrix, matrix.llt().solve(BodyMass<dim>::Matrix::Identity())};
}

template <int dim>
TwistVector<dim> free_twist(const BodyMass<dim>& mass, const TwistVector<dim>& momentum,
                            double dt) {
  constexpr int n_turns = n_rotations<dim>;
  const InertiaTensor<dim> inertia = mass.matrix.template bottomRightCorner<n_turns, n_turns>();
  TwistVector<dim> twist;
  twist << momentum.template head<dim>() / mass.matrix(0, 0),
      free_turn<dim>(inertia, momentum.template tail<n_turns>(), dt) / dt;
  return twist;
}

template <int dim>
std::vector<BodyPose<dim>> poses_after(const ClosingProblem<dim>& problem,
                                       const std::vector<BodyMotion<dim>>& motions) {
  std::vector<BodyPose<dim>> poses = problem.ends;
  for (const int body : problem.mechanism.bodies)
    poses[body] = moved(problem.poses[body], motions[body].twist, problem.dt);
  return poses;
}

template <int dim>
bool close_joints(const ClosingProblem<dim>& problem, Answer answer,
                  std::vector<BodyMotion<dim>>& motions) {
  constexpr int most_iterations = 30;
  constexpr double closed = 1e-13, good_enough = 1e-10;
  const Rows<dim> all(problem);
  const double fits = std::max(good_enough, all.round_off());
  Eigen::MatrixXd rows;
  Eigen::VectorXd gaps;
  all.evaluate(problem.poses, rows, gaps);
  const Impulses<dim> impulses(problem, all, rows);
  std::vector<BodyMotion<dim>> trial = motions;
  double before = 1e300;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    find_twists(problem, answer, motions, trial);
    all.evaluate(poses_after(problem, trial), rows, gaps);
    const double size = gaps.size() > 0 ? gaps.template lpNorm<Eigen::Infinity>() : 0;
    if (!std::isfinite(size))
      return false;
    if (size <= closed || (size <= fits && size > 0.5 * before)) {
      motions = trial;
      return true;
    }
    before = size;
    for (const int body : problem.mechanism.bodies) {
      auto turns = rows.middleCols(all.column(body) + dim, n_rotations<dim>);
      const AngularVector<dim> turn =
          problem.dt * trial[body].twist.template tail<n_rotations<dim>>();
      turns = (turns * change_of_rotation(turn)).eval();
    }
    impulses.give(impulses.that_change(rows, gaps), -1 / problem.dt, trial);
  }
  return false;
}

template <int dim>
void let_joints_hold(const ClosingProblem<dim>& problem, std::vector<BodyMotion<dim>>& motions) {
  const Rows<dim> all(problem);
  Eigen::MatrixXd rows;
  Eigen::VectorXd gaps, velocity(all.n_columns());
  all.evaluate(problem.poses, rows, gaps);
  for (const int body : problem.mechanism.bodies)
    velocity.template segment<n_twist<dim>>(all.column(body)) =
        problem.masses[body].inverse * motions[body].momentum;
  const Impulses<dim> impulses(problem, all, rows);
  impulses.give(impulses.that_change(rows, rows * velocity), -1, motions);
}

template <int dim>
void follow_rates(const ClosingProblem<dim>& problem, const Eigen::VectorXd& change,
                  std::vector<BodyMotion<dim>>& motions) {
  std::vector<BodyPose<dim>> poses = problem.ends;
  const Mechanism& mechanism = problem.mechanism;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const int body = mechanism.bodies[b];
    if (mechanism.carriers[b] < 0) {
      poses[body] = moved(problem.poses[body], motions[body].twist, problem.dt);
      continue;
    }
    const Joint<dim>& joint = problem.joints[mechanism.carriers[b]];
    const int side = joint.sides[1].body == body ? 1 : 0;
    const auto n = static_cast<Eigen::Index>(joint.q.size());
    const RelativePose<dim> goal =
        joint.kind->pose_of(joint.kind->advanced(joint.q, change.segment(joint.first_rate, n)));
    const JointSide<dim>& carrier = joint.sides[1 - side];
    const JointSide<dim>& own = joint.sides[side];
    const BodyPose<dim> parent = pose_of(poses, carrier.body);
    // The joint's axes at both sides, from the carrier's.
    const Axes<dim> known = parent.rotation * carrier.axes;
    const Axes<dim> axes =
        side == 1 ? Axes<dim>(known * goal.rotation) : Axes<dim>(known * goal.rotation.transpose());
    const Point<dim> anchor = parent.position + parent.rotation * carrier.point;
    const Point<dim> offset =
        side == 1 ? Point<dim>(known * goal.offset) : Point<dim>(-(axes * goal.offset));
    poses[body].rotation = axes * own.axes.transpose();
    poses[body].position = anchor + offset - poses[body].rotation * own.point;
    motions[body].twist = twist_to(problem.poses[body], poses[body], problem.dt);
  }
}

template <int dim>
double reach(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints) {
  double farthest = 0;
  for (const int j : mechanism.joints) {
    for (const JointSide<dim>& side : joints[j].sides)
      farthest = std::max(farthest, side.body == space ? 0 : side.point.norm());
  }
  return farthest > 0 ? farthest : 1;
}

template <int dim>
double largest_gap(const Joint<dim>& joint, const std::vector<BodyPose<dim>>& poses, double unit) {
  const RelativePose<dim> pose = place_of(joint, poses).pose;
  const std::vector<Screw<dim>> held = joint.kind->held_rows(pose);
  const Eigen::VectorXd open = joint.kind->gap(pose);
  double largest = 0;
  for (std::size_t k = 0; k < held.size(); ++k) {
    const double scale = held[k].linear.isZero(0) ? 1 : 1 / unit;
    largest = std::max(largest, scale * std::abs(open[static_cast<Eigen::Index>(k)]));
  }
  return largest;
}

template BodyPose<2> moved(const BodyPose<2>&, const TwistVector<2>&, double);
template BodyPose<3> moved(const BodyPose<3>&, const TwistVector<3>&, double);
template TwistVector<2> twist_to(const BodyPose<2>&, const BodyPose<2>&, double);
template TwistVector<3> twist_to(const BodyPose<3>&, const BodyPose<3>&, double);
template BodyMass<2> mass_of<2>(const BodyMass<2>::Matrix&);
template TwistVector<2> free_twist(const BodyMass<2>&, const TwistVector<2>&, double);
template std::vector<BodyPose<2>> poses_after(const ClosingProblem<2>&,
                                              const std::vector<BodyMotion<2>>&);
template bool close_joints(const ClosingProblem<2>&, Answer, std::vector<BodyMotion<2>>&);
template void let_joints_hold(const ClosingProblem<2>&, std::vector<BodyMotion<2>>&);
template void follow_rates(const ClosingProblem<2>&, const Eigen::VectorXd&,
                           std::vector<BodyMotion<2>>&);
template BodyMass<3> mass_of<3>(const BodyMass<3>::Matrix&);
template TwistVector<3> free_twist(const BodyMass<3>&, const TwistVector<3>&, double);
template std::vector<BodyPose<3>> poses_after(const ClosingProblem<3>&,
                                              const std::vector<BodyMotion<3>>&);
template bool close_joints(const ClosingProblem<3>&, Answer, std::vector<BodyMotion<3>>&);
template void let_joints_hold(const ClosingProblem<3>&, std::vector<BodyMotion<3>>&);
template void follow_rates(const ClosingProblem<3>&, const Eigen::VectorXd&,
                           std::vector<BodyMotion<3>>&);
template double reach(const Mechanism&, const std::vector<Joint<2>>&);
template double reach(const Mechanism&, const std::vector<Joint<3>>&);
template double largest_gap(const Joint<2>&, const std::vector<BodyPose<2>>&, double);
template double largest_gap(const Joint<3>&, const std::vector<BodyPose<3>>&, double);

}  // namespace lockstep
