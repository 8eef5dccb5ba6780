// Motion of a mechanism's bodies with its dofs.
#include "articulated/mechanism.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <unordered_map>

#include "base/round_off.hpp"

namespace lockstep {

template <int dim>
JointPlace<dim> place_of(const Joint<dim>& joint, const std::vector<BodyPose<dim>>& poses) {
  const auto& [first, second] = joint.sides;
  const BodyPose<dim> carrier = pose_of(poses, first.body), carried = pose_of(poses, second.body);
  JointPlace<dim> place;
  place.point = carried.position + carried.rotation * second.point;
  place.axes = carrier.rotation * first.axes;
  const Point<dim> anchor = carrier.position + carrier.rotation * first.point;
  place.pose.offset = place.axes.transpose() * (place.point - anchor);
  place.pose.rotation = place.axes.transpose() * carried.rotation * second.axes;
  return place;
}

namespace {

AngularVector<2> turned_axes(const Axes<2>&, const AngularVector<2>& vector) {
  return vector;
}
AngularVector<3> turned_axes(const Axes<3>& axes, const AngularVector<3>& vector) {
  return axes * vector;
}

}  // namespace

template <int dim>
TwistVector<dim> row_on_side(const Screw<dim>& row, const JointPlace<dim>& place, int side,
                             const Point<dim>& reference) {
  const Point<dim> linear = place.axes * row.linear;
  TwistVector<dim> result;
  result << linear,
      cross<dim>(place.point - reference, linear) + turned_axes(place.axes, row.angular);
  return side == 1 ? result : TwistVector<dim>(-result);
}

namespace {

template <int dim>
using Twists = Eigen::Matrix<double, n_twist<dim>, Eigen::Dynamic>;

/// The twist of the same rigid motion with another reference point, `arm` away.
template <int dim>
Twists<dim> carried_to(const Twists<dim>& twists, const Point<dim>& arm) {
  Twists<dim> result = twists;
  for (Eigen::Index c = 0; c < twists.cols(); ++c) {
    const AngularVector<dim> turn = twists.col(c).template tail<n_rotations<dim>>();
    result.col(c).template head<dim>() += rotate<dim>(turn, arm);
  }
  return result;
}

/// Fills the twists of all bodies of the tree, with `columns`.
template <int dim>
class TreeMotion {
 public:
  TreeMotion(const Mechanism& mechanism, const std::vector<JointedBody<dim>>& bodies,
             const std::vector<Joint<dim>>& joints, const std::vector<BodyPose<dim>>& poses,
             const RateDofs& dofs)
      : joints_(joints), poses_(poses) {
    const auto add_columns = [this](GlobalIndex first, int n) {
      const int column = static_cast<int>(basis_.columns.size());
      for (int k = 0; k < n; ++k)
        basis_.columns.push_back(first + k);
      return column;
    };
    if (mechanism.root != space)
      add_columns(bodies[mechanism.root].first_dof, n_twist<dim>);
    for (const int ground : mechanism.grounds)
      ground_columns_.emplace_back(ground, add_columns(dofs.first_of_body[ground], n_twist<dim>));
    for (const int j : mechanism.joints) {
      if (joints[j].first_rate >= 0)
        rate_columns_[j] =
            add_columns(dofs.first_rate + joints[j].first_rate, joints[j].kind->n_rates());
    }
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
      basis_.twists.push_back(twists_of_next(mechanism.bodies[b], mechanism.carriers[b]));
      place_of_body_[mechanism.bodies[b]] = static_cast<int>(b);
    }
  }

  /// Twists of a body of the tree, of a prescribed one, or of space.
  Twists<dim> twists(int body) const {
    if (const auto place = place_of_body_.find(body); place != place_of_body_.end())
      return basis_.twists[place->second];
    Twists<dim> result = none();
    for (const auto& [ground, column] : ground_columns_) {
      if (ground == body)
        result.middleCols(column, n_twist<dim>).setIdentity();
    }
    return result;
  }
  MotionBasis<dim>& basis() { return basis_; }

 private:
  Twists<dim> none() const {
    return Twists<dim>::Zero(n_twist<dim>, static_cast<Eigen::Index>(basis_.columns.size()));
  }

  Twists<dim> twists_of_next(int body, int carrier) const {
    if (carrier < 0) {
      Twists<dim> root = none();
      root.leftCols(n_twist<dim>).setIdentity();
      return root;
    }
    const Joint<dim>& joint = joints_[carrier];
    const int side = joint.sides[1].body == body ? 1 : 0;
    const int parent = joint.sides[1 - side].body;
    const JointPlace<dim> place = place_of(joint, poses_);
    Twists<dim> twists =
        carried_to<dim>(this->twists(parent), place.point - pose_of(poses_, parent).position);
    const std::vector<Screw<dim>> free = joint.kind->free_screws(place.pose);
    for (std::size_t k = 0; k < free.size(); ++k) {
      TwistVector<dim> motion;
      motion << place.axes * free[k].linear, turned_axes(place.axes, free[k].angular);
      twists.col(rate_columns_.at(carrier) + static_cast<Eigen::Index>(k)) +=
          (side == 1 ? 1 : -1) * motion;
    }
    return carried_to<dim>(twists, pose_of(poses_, body).position - place.point);
  }

  const std::vector<Joint<dim>>& joints_;
  const std::vector<BodyPose<dim>>& poses_;
  // numbers of this mechanism alone, since there may be as many mechanisms as bodies
  std::unordered_map<int, int> place_of_body_, rate_columns_;
  std::vector<std::pair<int, int>> ground_columns_;
  MotionBasis<dim> basis_;
};

/// Constraints of the loops, over the columns of the tree. Lengths count in `unit`. `size`:
/// magnitude of the motions of sides that rows compare; for a redundant loop these cancel to
/// round-off.
template <int dim>
Eigen::MatrixXd loop_rows(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints,
                          const std::vector<BodyPose<dim>>& poses, const TreeMotion<dim>& tree,
                          double unit, double& size) {
  std::vector<Eigen::RowVectorXd> rows;
  size = 0;
  for (const int j : mechanism.loops) {
    const JointPlace<dim> place = place_of(joints[j], poses);
    for (const Screw<dim>& held : joints[j].kind->held_rows(place.pose)) {
      const double scale = held.linear.isZero(0) ? 1 : 1 / unit;
      Eigen::RowVectorXd row;
      for (int side = 0; side < 2; ++side) {
        const int body = joints[j].sides[side].body;
        const TwistVector<dim> reads =
            row_on_side(held, place, side, pose_of(poses, body).position);
        const Eigen::RowVectorXd part = scale * reads.transpose() * tree.twists(body);
        size = std::max(size, part.template lpNorm<Eigen::Infinity>());
        row = side == 0 ? part : Eigen::RowVectorXd(row + part);
      }
      rows.push_back(std::move(row));
    }
  }
  Eigen::MatrixXd all(rows.size(), rows.empty() ? 0 : rows.front().size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    all.row(static_cast<Eigen::Index>(r)) = rows[r];
  return all;
}

template <int dim>
double extent(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints,
              const std::vector<BodyPose<dim>>& poses) {
  Box<dim> box;
  for (const int j : mechanism.joints)
    box.extend(place_of(joints[j], poses).point);
  for (const int body : mechanism.bodies)
    box.extend(poses[body].position);
  return box.diagonal().norm() > 0 ? box.diagonal().norm() : 1;
}

}  // namespace

template <int dim>
MotionBasis<dim> motion_basis(const Mechanism& mechanism,
                              const std::vector<JointedBody<dim>>& bodies,
                              const std::vector<Joint<dim>>& joints,
                              const std::vector<BodyPose<dim>>& poses, const RateDofs& dofs,
                              const std::vector<char>& given) {
  constexpr double dependent = rounding::differences;  // part of the motions that are compared [1]
  TreeMotion<dim> tree(mechanism, bodies, joints, poses, dofs);
  MotionBasis<dim>& basis = tree.basis();
  if (mechanism.loops.empty())
    return basis;
  double size = 0;
  const Eigen::MatrixXd all =
      loop_rows(mechanism, joints, poses, tree, extent(mechanism, joints, poses), size);
  // A free root moves all sides of all loops alike: its columns are round-off.
  std::vector<int> free, held;
  const GlobalIndex n_all = static_cast<GlobalIndex>(given.size());
  for (int c = 0; c < static_cast<int>(basis.columns.size()); ++c) {
    const GlobalIndex rate = basis.columns[c] - dofs.first_rate;
    const bool is_rate = rate >= 0 && rate < n_all;
    if (is_rate && !given[rate])
      free.push_back(c);
    else if (is_rate || mechanism.root == space)
      held.push_back(c);
  }
  if (free.empty())
    return basis;
  Eigen::MatrixXd of_free(all.rows(), free.size());
  for (std::size_t k = 0; k < free.size(); ++k)
    of_free.col(static_cast<Eigen::Index>(k)) = all.col(free[k]);
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(of_free);
  const auto pivots = qr.matrixQR().diagonal().cwiseAbs();
  const Eigen::Index rank = (pivots.array() > dependent * size).count();
  const Eigen::MatrixXd rotated = qr.householderQ().transpose() * all;
  const auto order = qr.colsPermutation().indices();
  const auto upper =
      qr.matrixQR().topLeftCorner(rank, rank).template triangularView<Eigen::Upper>();
  std::vector<int> others = held;
  for (auto k = rank; k < static_cast<Eigen::Index>(free.size()); ++k)
    others.push_back(free[order[k]]);
  Eigen::MatrixXd weights(rank, basis.columns.size());
  weights.setZero();
  for (const int c : others)
    weights.col(c) = -upper.solve(Eigen::VectorXd(rotated.col(c).head(rank)));
  for (Eigen::Index k = 0; k < rank; ++k)
    basis.dependent.emplace_back(free[order[k]], weights.row(k));
  for (Twists<dim>& twists : basis.twists) {
    for (const auto& [column, row] : basis.dependent) {
      const TwistVector<dim> motion = twists.col(column);
      twists.col(column).setZero();
      twists += motion * row;
    }
  }
  return basis;
}

template JointPlace<2> place_of(const Joint<2>&, const std::vector<BodyPose<2>>&);
template JointPlace<3> place_of(const Joint<3>&, const std::vector<BodyPose<3>>&);
template TwistVector<2> row_on_side(const Screw<2>&, const JointPlace<2>&, int, const Point<2>&);
template TwistVector<3> row_on_side(const Screw<3>&, const JointPlace<3>&, int, const Point<3>&);
template MotionBasis<2> motion_basis(const Mechanism&, const std::vector<JointedBody<2>>&,
                                     const std::vector<Joint<2>>&, const std::vector<BodyPose<2>>&,
                                     const RateDofs&, const std::vector<char>&);
template MotionBasis<3> motion_basis(const Mechanism&, const std::vector<JointedBody<3>>&,
                                     const std::vector<Joint<3>>&, const std::vector<BodyPose<3>>&,
                                     const RateDofs&, const std::vector<char>&);

}  // namespace lockstep
