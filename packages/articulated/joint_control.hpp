#pragma once
#include <limits>
#include <optional>
#include <string>

#include "articulated/joint_kind.hpp"
#include "articulated/joint_target.hpp"

namespace lockstep {

/// free: none. proportional_derivative: a spring and a damper to the target, which yields to loads.
/// prescribed_rate: the rates of such an oscillator, whatever they take. prescribed: the target.
enum class ControlType { free, proportional_derivative, prescribed_rate, prescribed };

/// What acts on the coordinates of a joint, alike on all of them.
struct JointControl {
  ControlType type = ControlType::free;
  JointTarget target;
  /// Of the oscillator [rad/s], [1]; gains are that times the inertia that the joint has at the
  /// start. Without it, gains are given.
  std::optional<double> natural_frequency;
  double damping_ratio = 1;
  Eigen::VectorXd stiffness, damping;  ///< gains, by coordinate [N m/rad, N/m], times s
  double largest_torque = std::numeric_limits<double>::infinity();  ///< [N m, N]

  bool given() const {
    return type == ControlType::prescribed || type == ControlType::prescribed_rate;
  }
  bool acts() const { return type == ControlType::proportional_derivative; }
};

/// Declares it in the list of a joint with n coordinates.
void declare_control(ParameterList& joint, int n);
/// Of a validated joint; `place`: see `read_target`. Throws InputError.
JointControl read_control(const ParameterList& joint, const std::string& name, int n,
                          const std::function<double(const ParameterArray<double>&)>& place);

/// Where a joint is to be after dt, and how fast, if that is given.
template <int dim>
TargetValue given_motion(const JointKind& kind, const JointControl& control,
                         const TargetValue& present, double time, double dt);

/// Spring and damper over a step: torque = `constant` - `slope` rate.
struct ControlLaw {
  Eigen::VectorXd constant, slope;
  bool limited = false;  ///< by the largest torque: then no slope
};
/// Where in a step springs and dampers act.
struct ControlTimes {
  double time = 0, dt = 0;  ///< its begin and length [s]
  double middle = 0.5;      ///< the part of it after which the spring is taken [1]
  double implicit = 1;      ///< part of the damper [1]
};
/// Of the second order: the spring is that of the middle of the step; in S1 the damper is implicit,
/// in S2 half of it. Fully implicit: both are those of the end.
template <int dim>
ControlLaw control_law(const JointKind& kind, const JointControl& control,
                       const TargetValue& present, const ControlTimes& times);

}  // namespace lockstep
