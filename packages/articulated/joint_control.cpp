#include "articulated/joint_control.hpp"

#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// From a pose at q to the target: a rotation vector for a ball.
template <int dim>
Eigen::VectorXd way_to(const JointKind& kind, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& target) {
  if (kind.turn != JointTurn::any)
    return target - q;
  return distance_to<dim>(kind, pose_of<dim>(kind, q), target);
}

/// The rates of a joint whose coordinates are those of the target.
template <int dim>
Eigen::VectorXd rates_of(const JointKind& kind, const JointTarget& target, double time) {
  if (kind.turn != JointTurn::any)
    return target(time).rate;
  constexpr double by = 1e-5;  // s
  return way_to<dim>(kind, target(time - by).q, target(time + by).q) / (2 * by);
}

/// x and its rate of x'' + 2 ratio frequency x' + frequency^2 x = 0 after dt.
void oscillate(double frequency, double ratio, double dt, Eigen::VectorXd& x, Eigen::VectorXd& v) {
  const double decay = ratio * frequency;
  const double square = frequency * frequency - decay * decay;  // of the damped frequency
  const double root = std::sqrt(std::abs(square)), phase = root * dt;
  // Both of e^(-decay dt) times cos, sin/root; where nothing oscillates cosh, sinh/root.
  double even, odd;
  if (phase < 1e-6) {
    even = std::exp(-decay * dt);
    odd = even * dt;
  } else if (square > 0) {
    even = std::exp(-decay * dt) * std::cos(phase);
    odd = std::exp(-decay * dt) * std::sin(phase) / root;
  } else {
    const double slow = std::exp((root - decay) * dt), fast = std::exp(-(root + decay) * dt);
    even = 0.5 * (slow + fast);
    odd = 0.5 * (slow - fast) / root;
  }
  const Eigen::VectorXd before = x;
  x = even * before + odd * (v + decay * before);
  v = (even - decay * odd) * v - frequency * frequency * odd * before;
}

}  // namespace

void declare_control(ParameterList& joint, int n) {
  declare_choice(
      joint, "Control", "free",
      {"free", "proportional derivative", "prescribed rate", "prescribed"},
      "What acts on the joint's coordinates. free: nothing; proportional derivative: a spring and "
      "a "
      "damper to \"Target\", which yields to loads; prescribed rate: the rates of a mass on such a "
      "spring, by whatever torque they take; prescribed: \"Target\" itself, likewise.");
  declare_optional<double>(
      joint, "Natural Frequency",
      "Of the oscillator that control makes of the joint, undamped [rad/s]. Springs are that "
      "squared times the inertia that the joint has at the start without fluid.");
  declare_at_least(joint, "Damping Ratio", 1.0, 0.0,
                   "1 is critical, with \"Natural Frequency\" [1].");
  declare_optional<double>(joint, "Stiffness",
                           "Of the spring, instead of a frequency [N m/rad, N/m].");
  declare_at_least(joint, "Damping", 0.0, 0.0,
                   "Of the damper beside \"Stiffness\" [N m s, N s/m].");
  declare_optional<double>(joint, "Largest Torque",
                           "Of spring and damper together [N m, N]. Absent: none.");
  for (const char* name : {"Natural Frequency", "Largest Torque"})
    set_positive(joint, name);
  set_at_least(joint, "Stiffness", 0);
  declare_target(joint, n);
}

JointControl read_control(const ParameterList& joint, const std::string& name, int n,
                          const std::function<double(const ParameterArray<double>&)>& place) {
  JointControl control;
  const auto& type = joint.get<std::string>("Control");
  if (type == "free")
    return control;
  control.type = type == "prescribed"        ? ControlType::prescribed
                 : type == "prescribed rate" ? ControlType::prescribed_rate
                                             : ControlType::proportional_derivative;
  control.target = read_target(joint, n, place, name);
  const bool by_frequency = joint.isParameter("Natural Frequency");
  const bool by_stiffness = joint.isParameter("Stiffness");
  check_input(!(by_frequency && by_stiffness),
              "The joint \"{}\" has both \"Natural Frequency\" and \"Stiffness\"; leave out one.",
              name);
  check_input(
      control.type == ControlType::prescribed || by_frequency || (by_stiffness && control.acts()),
      "The joint \"{}\" is under \"{}\" control, but has no \"Natural Frequency\"; give one{}.",
      name, type, control.acts() ? ", or \"Stiffness\" and \"Damping\"" : "");
  control.damping_ratio = joint.get<double>("Damping Ratio");
  if (by_frequency)
    control.natural_frequency = joint.get<double>("Natural Frequency");
  control.stiffness =
      Eigen::VectorXd::Constant(n, by_stiffness ? joint.get<double>("Stiffness") : 0);
  control.damping = Eigen::VectorXd::Constant(n, joint.get<double>("Damping"));
  if (joint.isParameter("Largest Torque"))
    control.largest_torque = joint.get<double>("Largest Torque");
  return control;
}

template <int dim>
TargetValue given_motion(const JointKind& kind, const JointControl& control,
                         const TargetValue& present, double time, double dt) {
  TargetValue end{control.target(time + dt).q, rates_of<dim>(kind, control.target, time + dt)};
  if (control.type == ControlType::prescribed)
    return end;
  // The way to the target is what oscillates.
  Eigen::VectorXd way = -way_to<dim>(kind, present.q, control.target(time).q);
  Eigen::VectorXd rate = present.rate - rates_of<dim>(kind, control.target, time);
  oscillate(*control.natural_frequency, control.damping_ratio, dt, way, rate);
  end.q = advanced<dim>(kind, end.q, way);
  end.rate += rate;
  return end;
}

template <int dim>
ControlLaw control_law(const JointKind& kind, const JointControl& control,
                       const TargetValue& present, const ControlTimes& times) {
  const double lead = times.middle * times.dt, middle = times.time + lead;
  const Eigen::VectorXd way = way_to<dim>(kind, present.q, control.target(middle).q);
  const Eigen::VectorXd wanted = rates_of<dim>(kind, control.target, middle);
  const auto& stiffness = control.stiffness;
  const auto& damping = control.damping;
  ControlLaw law;
  const double explicit_part = 1 - times.implicit;
  law.constant =
      stiffness.cwiseProduct(way) + damping.cwiseProduct(wanted - explicit_part * present.rate);
  law.slope = lead * stiffness + (1 - explicit_part) * damping;
  const Eigen::VectorXd expected = stiffness.cwiseProduct(way - lead * present.rate) +
                                   damping.cwiseProduct(wanted - present.rate);
  for (Eigen::Index k = 0; k < expected.size(); ++k) {
    if (std::abs(expected[k]) <= control.largest_torque)
      continue;
    law.constant[k] = std::copysign(control.largest_torque, expected[k]);
    law.slope[k] = 0;
    law.limited = true;
  }
  return law;
}

template TargetValue given_motion<2>(const JointKind&, const JointControl&, const TargetValue&,
                                     double, double);
template TargetValue given_motion<3>(const JointKind&, const JointControl&, const TargetValue&,
                                     double, double);
template ControlLaw control_law<2>(const JointKind&, const JointControl&, const TargetValue&,
                                   const ControlTimes&);
template ControlLaw control_law<3>(const JointKind&, const JointControl&, const TargetValue&,
                                   const ControlTimes&);

}  // namespace lockstep
