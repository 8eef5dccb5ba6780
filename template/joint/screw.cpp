// A joint and a target of your own, for `simulate --plug-in libscrew.so`.
#include "articulated/joint_registry.hpp"
#include "interfaces/plug_ins.hpp"
#include "smooth_step.hpp"
using namespace lockstep;

namespace {

constexpr JointFreedom one_angle{0, 1, 1};  // an angle, about the axis that a scene names

/// A nut on a screw: with each turn about the axis it goes along it by a lead. q is the angle.
class Screwed : public JointKind<3> {
 public:
  explicit Screwed(double lead) : JointKind<3>(one_angle), advance_(lead / (2 * pi)) {}

  std::vector<Screw<3>> free_screws(const RelativePose<3>&) const override {
    return {{advance_ * Point<3>::UnitX(), Point<3>::UnitX()}};
  }
  std::vector<Screw<3>> held_rows(const RelativePose<3>&) const override {
    const Point<3> none = Point<3>::Zero();
    return {{Point<3>::UnitX(), -advance_ * Point<3>::UnitX()},
            {Point<3>::UnitY(), none},
            {Point<3>::UnitZ(), none},
            {none, Point<3>::UnitY()},
            {none, Point<3>::UnitZ()}};
  }
  Eigen::VectorXd gap(const RelativePose<3>& pose) const override {
    Eigen::VectorXd gap(5);
    gap << pose.offset.x() - advance_ * angle(pose), pose.offset.tail<2>(), axis_gap(pose.rotation);
    return gap;
  }
  Eigen::VectorXd coordinates(const RelativePose<3>& pose, const Eigen::VectorXd&) const override {
    return Eigen::VectorXd::Constant(1, angle(pose));
  }
  RelativePose<3> pose_of(const Eigen::VectorXd& q) const override {
    const Eigen::AngleAxisd turn(q[0], Point<3>::UnitX());
    return {advance_ * q[0] * Point<3>::UnitX(), turn.toRotationMatrix()};
  }

 private:
  /// The way along the axis tells how many whole turns there were.
  double angle(const RelativePose<3>& pose) const {
    return nearest_angle(angle_about_first(pose.rotation), pose.offset.x() / advance_);
  }

  double advance_;  ///< way along the axis by angle [m/rad]
};

ParameterList screw_parameters(const TargetRegistry& targets) {
  ParameterList list = joint_parameters<3>(one_angle, targets);
  declare_required_positive(list, "Lead", "Way along the axis by turn, right-handed [m].");
  return list;
}

}  // namespace

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  plug_ins.space.part<JointRegistry<3>>().add(
      "screw", "Goes along an axis as it turns about it: a nut on a screw.", screw_parameters,
      [](const ParameterList& list) {
        return std::make_unique<Screwed>(list.get<double>("Lead"));
      });
  for (TargetRegistry* targets :
       {&plug_ins.plane.part<TargetRegistry>(), &plug_ins.space.part<TargetRegistry>()})
    targets->add("smooth step", "Goes from 0 to a value, and stays.", smooth_step_parameters,
                 smooth_step);
}
