#include "articulated/joint_kind.hpp"

#include <algorithm>
#include <cmath>

#include "motion/free_rotation.hpp"

namespace lockstep {

namespace {

constexpr double full_turn = 6.283185307179586;

template <int dim>
AngularVector<dim> rotation_vector_of(const Axes<dim>& rotation) {
  return rotation_vector<dim>(Orientation<dim>(rotation));
}

template <int dim>
Axes<dim> rotation_about(int axis, double angle) {
  return rotation_of<dim>(angle * AngularVector<dim>::Unit(axis)).toRotationMatrix();
}

/// The angle of a rotation about the first axis.
double angle_about_first(const Axes<2>& rotation) {
  return std::atan2(rotation(1, 0), rotation(0, 0));
}
double angle_about_first(const Axes<3>& rotation) {
  return std::atan2(rotation(2, 1), rotation(1, 1));
}

double nearest_angle(double angle, double near) {
  return near + std::remainder(angle - near, full_turn);
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

/// a x (rotated a), without its part along a: how far the axes of both sides are apart.
Eigen::VectorXd axis_gap(const Axes<2>&) {
  return {};
}
Eigen::VectorXd axis_gap(const Axes<3>& rotation) {
  const Point<3> between = Point<3>::UnitX().cross(Point<3>(rotation.col(0)));
  return between.tail<2>();
}

bool slides_along(const JointKind& kind, int axis) {
  return std::find(kind.slides.begin(), kind.slides.end(), axis) != kind.slides.end();
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
Axes<dim> rotation_at(const JointKind& kind, const Eigen::VectorXd& angles) {
  switch (kind.turn) {
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

template <int dim>
Eigen::VectorXd angles_of(const JointKind& kind, const Axes<dim>& rotation,
                          const Eigen::VectorXd& near) {
  switch (kind.turn) {
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

}  // namespace

template <int dim>
std::vector<DescribedKind> joint_kinds() {
  std::vector<DescribedKind> kinds = {
      {{"hinge", {}, JointTurn::axis}, "Turns about an axis."},
      {{"slider", {0}, JointTurn::none}, "Slides along an axis, and does not turn."},
      {{"weld", {}, JointTurn::none}, "Holds fast."}};
  if (dim == 3) {
    kinds.insert(kinds.begin(), {{"ball", {}, JointTurn::any}, "Turns about any axis."});
    kinds.push_back(
        {{"universal", {}, JointTurn::two_axes},
         "Turns about \"Axis\", fixed to the first solid, and \"Second Axis\", fixed to "
         "the second."});
    kinds.push_back(
        {{"cylinder", {0}, JointTurn::axis}, "Slides along an axis and turns about it."});
    kinds.push_back({{"planar", {1, 2}, JointTurn::axis},
                     "Slides across an axis in both directions and turns about it."});
  }
  return kinds;
}

template <int dim>
int n_rates(const JointKind& kind) {
  return static_cast<int>(kind.slides.size()) + n_turns<dim>(kind.turn);
}

template <int dim>
bool has_separate_coordinates(const JointKind& kind) {
  return n_rates<dim>(kind) > 1 && kind.turn != JointTurn::any;
}

template <int dim>
std::vector<Screw<dim>> free_screws(const JointKind& kind, const RelativePose<dim>& pose) {
  std::vector<Screw<dim>> screws;
  for (const int axis : kind.slides)
    screws.push_back(sliding<dim>(axis));
  if (kind.turn != JointTurn::none)
    screws.push_back(turning<dim>(AngularVector<dim>::Unit(0)));
  if (kind.turn == JointTurn::two_axes)
    screws.push_back(turning<dim>(second_axis(pose.rotation)));
  for (int k = 1; k < n_rotations<dim> && kind.turn == JointTurn::any; ++k)
    screws.push_back(turning<dim>(AngularVector<dim>::Unit(k)));
  return screws;
}

template <int dim>
std::vector<Screw<dim>> rate_rows(const JointKind& kind, const RelativePose<dim>& pose) {
  std::vector<Screw<dim>> rows = free_screws(kind, pose);
  if (kind.turn == JointTurn::two_axes) {
    AngularVector<dim>& a = rows[0].angular;
    AngularVector<dim>& b = rows[1].angular;
    const double cosine = a.dot(b), square = 1 - cosine * cosine;
    const AngularVector<dim> dual = (a - cosine * b) / square;
    b = (b - cosine * a) / square;
    a = dual;
  }
  return rows;
}

template <int dim>
std::vector<Screw<dim>> held_rows(const JointKind& kind, const RelativePose<dim>& pose) {
  std::vector<Screw<dim>> rows;
  for (int axis = 0; axis < dim; ++axis) {
    if (!slides_along(kind, axis))
      rows.push_back(sliding<dim>(axis));
  }
  if (kind.turn == JointTurn::two_axes)
    rows.push_back(turning<dim>(across(AngularVector<dim>::Unit(0), second_axis(pose.rotation))));
  const bool holds_axis = kind.turn == JointTurn::none || kind.turn == JointTurn::axis;
  for (int k = n_turns<dim>(kind.turn); holds_axis && k < n_rotations<dim>; ++k)
    rows.push_back(turning<dim>(AngularVector<dim>::Unit(k)));
  return rows;
}

template <int dim>
Eigen::VectorXd gap(const JointKind& kind, const RelativePose<dim>& pose) {
  std::vector<double> values;
  for (int axis = 0; axis < dim; ++axis) {
    if (!slides_along(kind, axis))
      values.push_back(pose.offset[axis]);
  }
  Eigen::VectorXd angles;
  if (kind.turn == JointTurn::none)
    angles = rotation_vector_of<dim>(pose.rotation);
  else if (kind.turn == JointTurn::axis)
    angles = axis_gap(pose.rotation);
  else if (kind.turn == JointTurn::two_axes)
    angles = Eigen::VectorXd::Constant(1, second_axis(pose.rotation)[0]);
  values.insert(values.end(), angles.data(), angles.data() + angles.size());
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

template <int dim>
Eigen::VectorXd coordinates(const JointKind& kind, const RelativePose<dim>& pose,
                            const Eigen::VectorXd& near) {
  const auto n_slides = static_cast<Eigen::Index>(kind.slides.size());
  Eigen::VectorXd q(n_rates<dim>(kind));
  for (Eigen::Index k = 0; k < n_slides; ++k)
    q[k] = pose.offset[kind.slides[k]];
  q.tail(q.size() - n_slides) = angles_of<dim>(kind, pose.rotation, near.tail(q.size() - n_slides));
  return q;
}

template <int dim>
RelativePose<dim> pose_of(const JointKind& kind, const Eigen::VectorXd& q) {
  const auto n_slides = static_cast<Eigen::Index>(kind.slides.size());
  RelativePose<dim> pose;
  for (Eigen::Index k = 0; k < n_slides; ++k)
    pose.offset[kind.slides[k]] = q[k];
  pose.rotation = rotation_at<dim>(kind, q.tail(q.size() - n_slides));
  return pose;
}

template <int dim>
Eigen::VectorXd advanced(const JointKind& kind, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& change) {
  if (kind.turn != JointTurn::any || dim == 2)
    return q + change;
  const Orientation<dim> before = rotation_of<dim>(AngularVector<dim>(q));
  const Orientation<dim> after = turned<dim>(AngularVector<dim>(change), before);
  return nearest_turn<dim>(rotation_vector<dim>(after), AngularVector<dim>(q + change));
}

template <int dim>
Eigen::VectorXd change_to(const JointKind& kind, const Eigen::VectorXd& q,
                          const Eigen::VectorXd& goal) {
  if (kind.turn != JointTurn::any || dim == 2)
    return goal - q;
  const Orientation<dim> turn = rotation_of<dim>(AngularVector<dim>(goal)) *
                                rotation_of<dim>(AngularVector<dim>(q)).inverse();
  return nearest_turn<dim>(rotation_vector<dim>(turn), AngularVector<dim>(goal - q));
}

template <int dim>
Eigen::VectorXd distance_to(const JointKind& kind, const RelativePose<dim>& pose,
                            const Eigen::VectorXd& q) {
  if (kind.turn != JointTurn::any || dim == 2)
    return q - coordinates<dim>(kind, pose, q);
  const Axes<dim> goal = rotation_of<dim>(AngularVector<dim>(q)).toRotationMatrix();
  return rotation_vector_of<dim>(goal * pose.rotation.transpose());
}

template std::vector<DescribedKind> joint_kinds<2>();
template std::vector<DescribedKind> joint_kinds<3>();
template int n_rates<2>(const JointKind&);
template int n_rates<3>(const JointKind&);
template bool has_separate_coordinates<2>(const JointKind&);
template bool has_separate_coordinates<3>(const JointKind&);
template std::vector<Screw<2>> free_screws(const JointKind&, const RelativePose<2>&);
template std::vector<Screw<3>> free_screws(const JointKind&, const RelativePose<3>&);
template std::vector<Screw<2>> rate_rows(const JointKind&, const RelativePose<2>&);
template std::vector<Screw<3>> rate_rows(const JointKind&, const RelativePose<3>&);
template std::vector<Screw<2>> held_rows(const JointKind&, const RelativePose<2>&);
template std::vector<Screw<3>> held_rows(const JointKind&, const RelativePose<3>&);
template Eigen::VectorXd gap(const JointKind&, const RelativePose<2>&);
template Eigen::VectorXd gap(const JointKind&, const RelativePose<3>&);
template Eigen::VectorXd coordinates(const JointKind&, const RelativePose<2>&,
                                     const Eigen::VectorXd&);
template Eigen::VectorXd coordinates(const JointKind&, const RelativePose<3>&,
                                     const Eigen::VectorXd&);
template RelativePose<2> pose_of(const JointKind&, const Eigen::VectorXd&);
template RelativePose<3> pose_of(const JointKind&, const Eigen::VectorXd&);
template Eigen::VectorXd advanced<2>(const JointKind&, const Eigen::VectorXd&,
                                     const Eigen::VectorXd&);
template Eigen::VectorXd advanced<3>(const JointKind&, const Eigen::VectorXd&,
                                     const Eigen::VectorXd&);
template Eigen::VectorXd change_to<2>(const JointKind&, const Eigen::VectorXd&,
                                      const Eigen::VectorXd&);
template Eigen::VectorXd change_to<3>(const JointKind&, const Eigen::VectorXd&,
                                      const Eigen::VectorXd&);
template Eigen::VectorXd distance_to(const JointKind&, const RelativePose<2>&,
                                     const Eigen::VectorXd&);
template Eigen::VectorXd distance_to(const JointKind&, const RelativePose<3>&,
                                     const Eigen::VectorXd&);

}  // namespace lockstep
