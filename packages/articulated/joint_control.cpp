#include "articulated/joint_control.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// From a pose at q to the target: a rotation vector for a ball.
template <int dim>
Eigen::VectorXd way_to(const JointKind<dim>& kind, const Eigen::VectorXd& q,
                       const Eigen::VectorXd& target) {
  if (!kind.freedom().rotation_vector)
    return target - q;
  return kind.distance_to(kind.pose_of(q), target);
}

/// The rates of a joint whose coordinates are those of the target.
template <int dim>
Eigen::VectorXd rates_of(const JointKind<dim>& kind, const JointControl& control, double time) {
  if (!kind.freedom().rotation_vector)
    return control.target_at(time).rate;
  constexpr double by = 1e-5;  // s
  return way_to<dim>(kind, control.target_at(time - by).q, control.target_at(time + by).q) /
         (2 * by);
}

/// x and its rate of x'' + 2 ratio frequency x' + frequency^2 x = 0 after dt.
void oscillate(double frequency, double ratio, double dt, double& x, double& v) {
  const double decay = ratio * frequency;
  const double square = frequency * frequency - decay * decay;  // square of the damped frequency
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
  const double before = x;
  x = even * before + odd * (v + decay * before);
  v = (even - decay * odd) * v - frequency * frequency * odd * before;
}

/// True if a target was written that is not the default one, as for a joint of `n` coordinates.
bool has_target(const ParameterList& list) {
  const ParameterList& target = list.sublist("Target");
  if (target.get<std::string>("Type") != "constant")
    return true;
  if (target.isType<double>("Value"))
    return target.get<double>("Value") != 0;
  const auto& values = target.get<ParameterArray<double>>("Value");
  return std::any_of(values.begin(), values.end(), [](double value) { return value != 0; });
}

/// Refuses parameters that a control of this type would not read: they must not seem to act.
void check_used(const ParameterList& list, const std::string& type, const std::string& name) {
  const bool has_springs = type == "proportional derivative";
  const bool oscillates = has_springs || type == "prescribed rate";
  const bool by_frequency = list.isParameter("Natural Frequency");
  const auto check = [&](bool used, const char* parameter, const std::string& beside = "") {
    const bool is_list = list.isSublist(parameter);
    check_input(used || !(is_list ? has_target(list) : list.isParameter(parameter)),
                "The joint \"{}\" has \"{}\", which \"{}\" control{} does not use; leave it out, "
                "or change \"Control\".",
                name, parameter, type, beside);
  };
  check(oscillates, "Natural Frequency");
  check(oscillates && by_frequency, "Damping Ratio",
        oscillates ? " without \"Natural Frequency\"" : "");
  check(has_springs, "Stiffness");
  check(has_springs && !by_frequency, "Damping", has_springs ? " with \"Natural Frequency\"" : "");
  check(has_springs, "Largest Torque");
  check(type != "free", "Target");
}

/// `name`: as messages have it.
CoordinateControl read_one_control(const ParameterList& list, const std::string& name) {
  CoordinateControl control;
  const auto& type = list.get<std::string>("Control");
  if (type == "free") {
    check_used(list, type, name);
    return control;
  }
  control.type = type == "prescribed"        ? ControlType::prescribed
                 : type == "prescribed rate" ? ControlType::prescribed_rate
                                             : ControlType::proportional_derivative;
  const bool by_frequency = list.isParameter("Natural Frequency");
  const bool by_stiffness = list.isParameter("Stiffness");
  check_input(!(by_frequency && by_stiffness),
              "The joint \"{}\" has both \"Natural Frequency\" and \"Stiffness\"; leave out one.",
              name);
  check_input(
      control.type == ControlType::prescribed || by_frequency || (by_stiffness && control.acts()),
      "The joint \"{}\" is under \"{}\" control, but has no \"Natural Frequency\"; give one{}.",
      name, type, control.acts() ? ", or \"Stiffness\" and \"Damping\"" : "");
  check_used(list, type, name);
  if (list.isParameter("Damping Ratio"))
    control.damping_ratio = list.get<double>("Damping Ratio");
  if (by_frequency)
    control.natural_frequency = list.get<double>("Natural Frequency");
  if (by_stiffness)
    control.stiffness = list.get<double>("Stiffness");
  if (list.isParameter("Damping"))
    control.damping = list.get<double>("Damping");
  if (list.isParameter("Largest Torque"))
    control.largest_torque = list.get<double>("Largest Torque");
  return control;
}

}  // namespace

TargetValue JointControl::target_at(double time) const {
  const auto n = static_cast<Eigen::Index>(coordinates.size());
  TargetValue value =
      target ? target(time) : TargetValue{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!coordinates[k].own_target)
      continue;
    const TargetValue own = coordinates[k].own_target(time);
    value.q[k] = own.q[0];
    value.rate[k] = own.rate[0];
  }
  return value;
}

bool JointControl::any_given() const {
  return std::any_of(coordinates.begin(), coordinates.end(),
                     [](const CoordinateControl& one) { return one.given(); });
}
bool JointControl::any_acts() const {
  return std::any_of(coordinates.begin(), coordinates.end(),
                     [](const CoordinateControl& one) { return one.acts(); });
}
bool JointControl::any() const {
  return any_given() || any_acts();
}

std::string coordinate_list(int k) {
  return "Coordinate " + std::to_string(k + 1);
}

void declare_control(ParameterList& list, int n, const TargetRegistry& targets) {
  declare_choice(
      list, "Control", "free", {"free", "proportional derivative", "prescribed rate", "prescribed"},
      "Control of the joint's coordinates. free: nothing; proportional derivative: a spring and a "
      "damper to \"Target\", which yields to loads; prescribed rate: the rates of a mass on such a "
      "spring, by whatever torque they take; prescribed: \"Target\" itself, likewise.");
  declare_optional<double>(
      list, "Natural Frequency",
      "Natural frequency of the oscillator that control makes of the joint, undamped [rad/s]. "
      "Springs are its square times the inertia that the joint has at the start without fluid.");
  declare_optional<double>(
      list, "Damping Ratio",
      "Damping ratio with \"Natural Frequency\", 1 is critical [1]; default 1.");
  declare_optional<double>(list, "Stiffness",
                           "Stiffness of the spring, instead of a frequency [N m/rad, N/m].");
  declare_optional<double>(list, "Damping",
                           "Damping beside \"Stiffness\" [N m s, N s/m]; default: no damper.");
  declare_optional<double>(list, "Largest Torque",
                           "Largest torque of spring and damper together [N m, N]. Absent: none. "
                           "Parameters that control does not use are refused.");
  for (const char* parameter : {"Natural Frequency", "Largest Torque"})
    set_positive(list, parameter);
  for (const char* parameter : {"Damping Ratio", "Stiffness", "Damping"})
    set_at_least(list, parameter, 0);
  declare_target(list, n, targets);
}

JointControl read_control(const ParameterList& joint, const JointFreedom& freedom,
                          const TargetSetting& setting, const TargetRegistry& targets) {
  const int n = setting.n;
  JointControl control;
  control.coordinates.assign(n, read_one_control(joint, setting.joint));
  if (control.any())
    control.target = read_target(joint, setting, targets);
  for (int k = 0; k < n && freedom.has_separate_coordinates(); ++k) {
    if (!joint.isSublist(coordinate_list(k)))
      continue;
    const ParameterList& list = joint.sublist(coordinate_list(k));
    const TargetSetting own{1, setting.joint + "/" + coordinate_list(k), setting.place};
    if (list.getEntry("Control").isDefault()) {
      check_used(list, "free", own.joint);
      continue;  // limits alone leave it what the joint has
    }
    control.coordinates[k] = read_one_control(list, own.joint);
    if (!control.coordinates[k].free())
      control.coordinates[k].own_target = read_target(list, own, targets);
  }
  return control;
}

template <int dim>
TargetValue given_motion(const JointKind<dim>& kind, const JointControl& control,
                         const TargetValue& present, double time, double dt) {
  TargetValue end{control.target_at(time + dt).q, rates_of<dim>(kind, control, time + dt)};
  // The way to the target is what oscillates.
  Eigen::VectorXd way = -way_to<dim>(kind, present.q, control.target_at(time).q);
  Eigen::VectorXd rate = present.rate - rates_of<dim>(kind, control, time);
  bool oscillates = false;
  for (Eigen::Index k = 0; k < way.size(); ++k) {
    const CoordinateControl& one = control.coordinates[k];
    if (one.type == ControlType::prescribed_rate) {
      oscillate(*one.natural_frequency, one.damping_ratio, dt, way[k], rate[k]);
      oscillates = true;
    } else {
      way[k] = rate[k] = 0;
    }
  }
  if (!oscillates)
    return end;
  end.q = kind.advanced(end.q, way);
  end.rate += rate;
  return end;
}

template <int dim>
ControlLaw control_law(const JointKind<dim>& kind, const JointControl& control,
                       const TargetValue& present, const ControlTimes& times) {
  const double lead = times.lead;
  const Eigen::VectorXd way = way_to<dim>(kind, present.q, control.target_at(times.target).q);
  const Eigen::VectorXd wanted = rates_of<dim>(kind, control, times.target);
  const double explicit_part = 1 - times.implicit;
  const Eigen::Index n = way.size();
  ControlLaw law{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), std::vector<char>(n, 0)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const CoordinateControl& one = control.coordinates[k];
    if (!one.acts())
      continue;
    const double rate = present.rate[k];
    law.constant[k] = one.stiffness * way[k] + one.damping * (wanted[k] - explicit_part * rate);
    law.slope[k] = lead * one.stiffness + (1 - explicit_part) * one.damping;
    const double expected =
        one.stiffness * (way[k] - lead * rate) + one.damping * (wanted[k] - rate);
    if (std::abs(expected) <= one.largest_torque)
      continue;
    law.constant[k] = std::copysign(one.largest_torque, expected);
    law.slope[k] = 0;
    law.limited[k] = 1;
  }
  return law;
}

double unresolved_part(const JointControl& control, double dt) {
  double largest = 0;
  for (const CoordinateControl& one : control.coordinates) {
    if (!one.acts())
      continue;
    if (one.inertia <= 0)  // no step resolves what has none
      return 1;
    const double decay = one.damping * dt / one.inertia;
    largest = std::max(largest, one.stiffness * dt * dt / one.inertia + decay * decay);
  }
  const double ratio = largest / 16;
  return ratio * ratio / (1 + ratio * ratio);
}

template TargetValue given_motion<2>(const JointKind<2>&, const JointControl&, const TargetValue&,
                                     double, double);
template TargetValue given_motion<3>(const JointKind<3>&, const JointControl&, const TargetValue&,
                                     double, double);
template ControlLaw control_law<2>(const JointKind<2>&, const JointControl&, const TargetValue&,
                                   const ControlTimes&);
template ControlLaw control_law<3>(const JointKind<3>&, const JointControl&, const TargetValue&,
                                   const ControlTimes&);

}  // namespace lockstep
