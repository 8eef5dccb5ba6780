#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "articulated/joint_kind.hpp"
#include "articulated/joint_target.hpp"

namespace lockstep {

/// free: none. proportional_derivative: a spring and a damper to the target, which yields to loads.
/// prescribed_rate: the rates of such an oscillator, whatever they take. prescribed: the target.
enum class ControlType { free, proportional_derivative, prescribed_rate, prescribed };

/// Control of one coordinate of a joint.
struct CoordinateControl {
  ControlType type = ControlType::free;
  /// Natural frequency of the oscillator [rad/s], which with the damping ratio [1] gives gains
  /// times the inertia that the joint has at the start. Without it, gains are given.
  std::optional<double> natural_frequency;
  double damping_ratio = 1;
  double stiffness = 0, damping = 0;  ///< gains [N m/rad, N/m], times s
  double inertia = 0;                 ///< inertia at the start, all other joints held [kg m^2, kg]
  double largest_torque = std::numeric_limits<double>::infinity();  ///< [N m, N]
  JointTarget own_target;  ///< target of this coordinate alone; null: it has that of the joint

  bool free() const { return type == ControlType::free; }
  bool given() const {
    return type == ControlType::prescribed || type == ControlType::prescribed_rate;
  }
  bool acts() const { return type == ControlType::proportional_derivative; }
};

/// Control of all coordinates of a joint. Those of a ball are alike.
struct JointControl {
  std::vector<CoordinateControl> coordinates;
  JointTarget
      target;  ///< target of all coordinates without their own; may be null if there are none

  /// Target of all coordinates; it has no meaning for free ones.
  TargetValue target_at(double time) const;
  bool free(int k) const { return coordinates[k].free(); }
  bool given(int k) const { return coordinates[k].given(); }
  bool any_given() const;
  bool any_acts() const;
  bool any() const;  ///< not all are free
};

/// Declares what acts on n coordinates alike.
void declare_control(ParameterList& list, int n, const TargetRegistry& targets);
/// Name of the list of one coordinate's own control; k: from 0.
std::string coordinate_list(int k);
/// Reads the control of a validated joint with such coordinates. Throws InputError.
JointControl read_control(const ParameterList& joint, const JointFreedom& freedom,
                          const TargetSetting& setting, const TargetRegistry& targets);

/// Values and rates of a joint's given coordinates after dt; the entries of others have no meaning.
template <int dim>
TargetValue given_motion(const JointKind<dim>& kind, const JointControl& control,
                         const TargetValue& present, double time, double dt);

/// Springs and dampers over a step, by coordinate: torque = `constant` - `slope` rate.
struct ControlLaw {
  Eigen::VectorXd constant, slope;
  std::vector<char> limited;  ///< by the largest torque: then no slope
};
/// Times in a step at which springs and dampers act.
struct ControlTimes {
  double target = 0;    ///< when the target is taken [s]
  double lead = 0;      ///< time for which the spring goes on from the present coordinates [s]
  double implicit = 1;  ///< part of the damper [1]
};
/// Linearises springs and dampers: those at the coordinates q + lead q', for the rates q' that a
/// solve finds.
template <int dim>
ControlLaw control_law(const JointKind<dim>& kind, const JointControl& control,
                       const TargetValue& present, const ControlTimes& times);
/// The part of springs and dampers that steps of dt do not resolve [0 to 1]: about 0 while both
/// turn their joints slowly, 1/2 where a spring has a period of one and a half steps.
double unresolved_part(const JointControl& control, double dt);

}  // namespace lockstep
