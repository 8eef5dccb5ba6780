// The types of joints that ship: each slides along some of its axes and turns about some.
#include <algorithm>
#include <cmath>

#include "articulated/joint_registry.hpp"
#include "motion/free_rotation.hpp"

namespace lockstep {

namespace {

/// Axes about which a joint turns: two_axes are the first of the first side and the second of the
/// second side.
enum class JointTurn { none, axis, two_axes, any };

template <int dim>
AngularVector<dim> rotation_vector_of(const Axes<dim>& rotation) {
  return rotation_vector<dim>(Orientation<dim>(rotation));
}

template <int dim>
Axes<dim> rotation_about(int axis, double angle) {
  return rotation_of<dim>(angle * AngularVector<dim>::Unit(axis)).toRotationMatrix();
}

template <int dim>
Screw<dim> sliding(int axis) {
  return {Point<dim>::Unit(axis), AngularVector<dim>::Zero()};
}
template <int dim>
Screw<dim> turning(const AngularVector<dim>& about) {
  return {Point<dim>::Zero(), about};
}

/// The second axis of two, seen from the first side.
AngularVector<2> second_axis(const Axes<2>&) {
  return AngularVector<2>::Zero();
}
AngularVector<3> second_axis(const Axes<3>& rotation) {
  return rotation.col(1);
}
/// b x a, about which two axes a and b do not turn.
AngularVector<2> across(const AngularVector<2>&, const AngularVector<2>&) {
  return AngularVector<2>::Zero();
}
AngularVector<3> across(const AngularVector<3>& a, const AngularVector<3>& b) {
  return b.cross(a);
}

template <int dim>
int n_turns(JointTurn turn) {
  switch (turn) {
    case JointTurn::none:
      return 0;
    case JointTurn::axis:
      return 1;
    case JointTurn::two_axes:
      return 2;
    case JointTurn::any:
      return n_rotations<dim>;
  }
  return 0;
}

template <int dim>
JointFreedom freedom_of(const std::vector<int>& slides, JointTurn turn) {
  JointFreedom freedom;
  freedom.displacements = static_cast<int>(slides.size());
  freedom.angles = n_turns<dim>(turn);
  freedom.rotation_vector = turn == JointTurn::any;
  if (turn == JointTurn::two_axes)
    freedom.axes = 2;
  else if (!slides.empty() || (dim == 3 && turn == JointTurn::axis))  // in 2D hinges need none
    freedom.axes = 1;
  return freedom;
}

/// The coordinates are displacements along the axes that it slides on, then angles: about the axis,
/// about the two axes one after the other, or a rotation vector.
template <int dim>
class SlidesAndTurns : public JointKind<dim> {
 public:
  SlidesAndTurns(const std::vector<int>& slides, JointTurn turn)
      : JointKind<dim>(freedom_of<dim>(slides, turn)), slides_(slides), turn_(turn) {}

  std::vector<Screw<dim>> free_screws(const RelativePose<dim>& pose) const override {
    std::vector<Screw<dim>> screws;
    for (const int axis : slides_)
      screws.push_back(sliding<dim>(axis));
    if (turn_ != JointTurn::none)
      screws.push_back(turning<dim>(AngularVector<dim>::Unit(0)));
    if (turn_ == JointTurn::two_axes)
      screws.push_back(turning<dim>(second_axis(pose.rotation)));
    for (int k = 1; k < n_rotations<dim> && turn_ == JointTurn::any; ++k)
      screws.push_back(turning<dim>(AngularVector<dim>::Unit(k)));
    return screws;
  }

  std::vector<Screw<dim>> held_rows(const RelativePose<dim>& pose) const override {
    std::vector<Screw<dim>> rows;
    for (int axis = 0; axis < dim; ++axis) {
      if (!slides_along(axis))
        rows.push_back(sliding<dim>(axis));
    }
    if (turn_ == JointTurn::two_axes)
      rows.push_back(turning<dim>(across(AngularVector<dim>::Unit(0), second_axis(pose.rotation))));
    const bool holds_axis = turn_ == JointTurn::none || turn_ == JointTurn::axis;
    for (int k = n_turns<dim>(turn_); holds_axis && k < n_rotations<dim>; ++k)
      rows.push_back(turning<dim>(AngularVector<dim>::Unit(k)));
    return rows;
  }

  Eigen::VectorXd gap(const RelativePose<dim>& pose) const override {
    std::vector<double> values;
    for (int axis = 0; axis < dim; ++axis) {
      if (!slides_along(axis))
        values.push_back(pose.offset[axis]);
    }
    Eigen::VectorXd angles;
    if (turn_ == JointTurn::none)
      angles = rotation_vector_of<dim>(pose.rotation);
    else if (turn_ == JointTurn::axis)
      angles = axis_gap(pose.rotation);
    else if (turn_ == JointTurn::two_axes)
      angles = Eigen::VectorXd::Constant(1, second_axis(pose.rotation)[0]);
    values.insert(values.end(), angles.data(), angles.data() + angles.size());
    return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

  Eigen::VectorXd coordinates(const RelativePose<dim>& pose,
                              const Eigen::VectorXd& near) const override {
    Eigen::VectorXd q(this->n_rates());
    for (Eigen::Index k = 0; k < n_slides(); ++k)
      q[k] = pose.offset[slides_[k]];
    const Eigen::Index n_angles = q.size() - n_slides();
    q.tail(n_angles) = angles_of(pose.rotation, near.tail(n_angles));
    return q;
  }

  RelativePose<dim> pose_of(const Eigen::VectorXd& q) const override {
    RelativePose<dim> pose;
    for (Eigen::Index k = 0; k < n_slides(); ++k)
      pose.offset[slides_[k]] = q[k];
    pose.rotation = rotation_at(q.tail(q.size() - n_slides()));
    return pose;
  }

  Eigen::VectorXd advanced(const Eigen::VectorXd& q, const Eigen::VectorXd& change) const override {
    if (turn_ != JointTurn::any)
      return q + change;
    const Orientation<dim> before = rotation_of<dim>(AngularVector<dim>(q));
    const Orientation<dim> after = turned<dim>(AngularVector<dim>(change), before);
    return nearest_turn<dim>(rotation_vector<dim>(after), AngularVector<dim>(q + change));
  }

  Eigen::VectorXd change_to(const Eigen::VectorXd& q, const Eigen::VectorXd& goal) const override {
    if (turn_ != JointTurn::any)
      return goal - q;
    const Orientation<dim> turn = rotation_of<dim>(AngularVector<dim>(goal)) *
                                  rotation_of<dim>(AngularVector<dim>(q)).inverse();
    return nearest_turn<dim>(rotation_vector<dim>(turn), AngularVector<dim>(goal - q));
  }

  Eigen::VectorXd distance_to(const RelativePose<dim>& pose,
                              const Eigen::VectorXd& q) const override {
    if (turn_ != JointTurn::any)
      return q - coordinates(pose, q);
    const Axes<dim> goal = rotation_of<dim>(AngularVector<dim>(q)).toRotationMatrix();
    return rotation_vector_of<dim>(goal * pose.rotation.transpose());
  }

 private:
  Eigen::Index n_slides() const { return static_cast<Eigen::Index>(slides_.size()); }
  bool slides_along(int axis) const {
    return std::find(slides_.begin(), slides_.end(), axis) != slides_.end();
  }

  Axes<dim> rotation_at(const Eigen::VectorXd& angles) const {
    switch (turn_) {
      case JointTurn::none:
        break;
      case JointTurn::axis:
        return rotation_about<dim>(0, angles[0]);
      case JointTurn::two_axes:
        return rotation_about<dim>(0, angles[0]) *
               rotation_about<dim>(n_rotations<dim> / 2, angles[1]);
      case JointTurn::any:
        return rotation_of<dim>(AngularVector<dim>(angles)).toRotationMatrix();
    }
    return Axes<dim>::Identity();
  }

  Eigen::VectorXd angles_of(const Axes<dim>& rotation, const Eigen::VectorXd& near) const {
    switch (turn_) {
      case JointTurn::none:
        break;
      case JointTurn::axis:
        return Eigen::VectorXd::Constant(1, nearest_angle(angle_about_first(rotation), near[0]));
      case JointTurn::two_axes:
        return Eigen::Vector2d(
            nearest_angle(angle_about_first(rotation), near[0]),
            nearest_angle(std::atan2(rotation(0, dim - 1), rotation(0, 0)), near[1]));
      case JointTurn::any:
        return nearest_turn<dim>(rotation_vector_of<dim>(rotation), AngularVector<dim>(near));
    }
    return {};
  }

  std::vector<int> slides_;  ///< axes
  JointTurn turn_;
};

}  // namespace

template <int dim>
void register_joints(JointRegistry<dim>& joints) {
  const auto add = [&joints](const char* name, const char* documentation,
                             const std::vector<int>& slides, JointTurn turn) {
    joints.add(
        name, documentation,
        [=](const TargetRegistry& targets) {
          return joint_parameters<dim>(freedom_of<dim>(slides, turn), targets);
        },
        [=](const ParameterList&) { return std::make_unique<SlidesAndTurns<dim>>(slides, turn); });
  };
  if (dim == 3)
    add("ball", "Turns about any axis.", {}, JointTurn::any);
  add("hinge", "Turns about an axis.", {}, JointTurn::axis);
  add("slider", "Slides along an axis, and does not turn.", {0}, JointTurn::none);
  add("weld", "Holds fast.", {}, JointTurn::none);
  if (dim == 2)
    return;
  add("universal",
      "Turns about \"Axis\", fixed to the first solid, and \"Second Axis\", fixed to the second.",
      {}, JointTurn::two_axes);
  add("cylinder", "Slides along an axis and turns about it.", {0}, JointTurn::axis);
  add("planar", "Slides across an axis in both directions and turns about it.", {1, 2},
      JointTurn::axis);
}

template void register_joints<2>(JointRegistry<2>&);
template void register_joints<3>(JointRegistry<3>&);

}  // namespace lockstep
