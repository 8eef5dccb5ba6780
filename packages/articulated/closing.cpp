#include "articulated/closing.hpp"

#include <Eigen/QR>
#include <cmath>

#include "motion/rotation.hpp"

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

/// How the rotation that `turn` [rad] makes changes with it: exp(turn + d) = exp(result d)
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
      n_rows_ += static_cast<int>(
          held_rows(problem.joints[j].kind, place_of(problem.joints[j], problem.poses).pose)
              .size());
      for (const CoordinateControl& control : problem.joints[j].control.coordinates)
        n_rows_ += control.given() ? 1 : 0;
    }
    unit_ = reach(problem.mechanism, problem.joints);
  }

  int n_columns() const { return n_columns_; }
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
      const std::vector<Screw<dim>> held = held_rows(joint.kind, place.pose);
      const Eigen::VectorXd open = gap(joint.kind, place.pose);
      for (std::size_t k = 0; k < held.size(); ++k)
        set(row++, held[k], open[k], joint, place, poses, rows, gaps);
      if (!joint.control.any_given())
        continue;
      const std::vector<Screw<dim>> rates = rate_rows(joint.kind, place.pose);
      const Eigen::VectorXd left = distance_to(joint.kind, place.pose, joint.goal.q);
      for (int k = 0; k < left.size(); ++k) {
        if (joint.control.given(k))
          set(row++, rates[k], -left[k], joint, place, poses, rows, gaps);
      }
    }
  }

 private:
  void set(int row, const Screw<dim>& screw, double value, const Joint<dim>& joint,
           const JointPlace<dim>& place, const std::vector<BodyPose<dim>>& poses,
           Eigen::MatrixXd& rows, Eigen::VectorXd& gaps) const {
    const double scale = screw.linear.isZero(0) ? 1 : 1 / unit_;
    gaps[row] = scale * value;
    for (int side = 0; side < 2; ++side) {
      const int body = joint.sides[side].body;
      if (body != space && column_[body] >= 0)
        rows.block(row, column_[body], 1, n_twist<dim>) +=
            scale * row_on_side(screw, place, side, poses[body].position).transpose();
    }
  }

  const ClosingProblem<dim>& problem_;
  std::vector<int> column_;
  int n_rows_ = 0, n_columns_ = 0;
  double unit_ = 1;
};

template <int dim>
std::vector<BodyPose<dim>> poses_after(const ClosingProblem<dim>& problem,
                                       const std::vector<TwistVector<dim>>& twists) {
  std::vector<BodyPose<dim>> poses = problem.ends;
  for (const int body : problem.mechanism.bodies)
    poses[body] = moved(problem.poses[body], twists[body], problem.dt);
  return poses;
}

}  // namespace

template <int dim>
bool close_joints(const ClosingProblem<dim>& problem, std::vector<TwistVector<dim>>& twists) {
  constexpr int most_iterations = 30;
  constexpr double closed = 1e-13, good_enough = 1e-10, dependent = 1e-9;
  const Rows<dim> all(problem);
  Eigen::MatrixXd rows;
  Eigen::VectorXd gaps;
  all.evaluate(problem.poses, rows, gaps);
  Eigen::MatrixXd response(all.n_columns(), rows.rows());  // M^-1 J^T
  for (const int body : problem.mechanism.bodies)
    response.middleRows(all.column(body), n_twist<dim>) =
        problem.inverse_masses[body] * rows.middleCols(all.column(body), n_twist<dim>).transpose();
  if (rows.rows() == 0)
    return true;
  // Each row scaled by how easily it is closed: bodies may be light and heavy.
  const Eigen::VectorXd ease = (rows * response).diagonal();
  const Eigen::VectorXd scale =
      (ease.array() > 0)
          .select(ease.array().max(1e-300).rsqrt(), Eigen::ArrayXd::Zero(ease.size()));
  response *= scale.asDiagonal();
  std::vector<TwistVector<dim>> trial = twists;
  double before = 1e300;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const std::vector<BodyPose<dim>> poses = poses_after(problem, trial);
    all.evaluate(poses, rows, gaps);
    const double size = gaps.template lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size))
      return false;
    if (size <= closed || (size <= good_enough && size > 0.5 * before)) {
      twists = trial;
      return true;
    }
    before = size;
    for (const int body : problem.mechanism.bodies) {
      auto turns = rows.middleCols(all.column(body) + dim, n_rotations<dim>);
      const AngularVector<dim> turn = problem.dt * trial[body].template tail<n_rotations<dim>>();
      turns = (turns * change_of_rotation(turn)).eval();
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(scale.asDiagonal() * rows *
                                                                   response);
    solver.setThreshold(dependent);
    const Eigen::VectorXd change = response * solver.solve(scale.cwiseProduct(gaps));
    for (const int body : problem.mechanism.bodies)
      trial[body] -= change.template segment<n_twist<dim>>(all.column(body)) / problem.dt;
  }
  return false;
}

template <int dim>
void follow_rates(const ClosingProblem<dim>& problem, const Eigen::VectorXd& change,
                  std::vector<TwistVector<dim>>& twists) {
  std::vector<BodyPose<dim>> poses = problem.ends;
  const Mechanism& mechanism = problem.mechanism;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const int body = mechanism.bodies[b];
    if (mechanism.carriers[b] < 0) {
      poses[body] = moved(problem.poses[body], twists[body], problem.dt);
      continue;
    }
    const Joint<dim>& joint = problem.joints[mechanism.carriers[b]];
    const int side = joint.sides[1].body == body ? 1 : 0;
    const auto n = static_cast<Eigen::Index>(joint.q.size());
    const RelativePose<dim> goal = pose_of<dim>(
        joint.kind, advanced<dim>(joint.kind, joint.q, change.segment(joint.first_rate, n)));
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
    twists[body] = twist_to(problem.poses[body], poses[body], problem.dt);
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
  const std::vector<Screw<dim>> held = held_rows(joint.kind, pose);
  const Eigen::VectorXd open = gap(joint.kind, pose);
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
template bool close_joints(const ClosingProblem<2>&, std::vector<TwistVector<2>>&);
template bool close_joints(const ClosingProblem<3>&, std::vector<TwistVector<3>>&);
template void follow_rates(const ClosingProblem<2>&, const Eigen::VectorXd&,
                           std::vector<TwistVector<2>>&);
template void follow_rates(const ClosingProblem<3>&, const Eigen::VectorXd&,
                           std::vector<TwistVector<3>>&);
template double reach(const Mechanism&, const std::vector<Joint<2>>&);
template double reach(const Mechanism&, const std::vector<Joint<3>>&);
template double largest_gap(const Joint<2>&, const std::vector<BodyPose<2>>&, double);
template double largest_gap(const Joint<3>&, const std::vector<BodyPose<3>>&, double);

}  // namespace lockstep
