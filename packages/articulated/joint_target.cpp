#include "articulated/joint_target.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// Grows from 0 to 1 without a jump of its rate.
struct Ramp {
  double part = 1, rate = 0;
  Ramp(double time, double length) {
    if (time >= length)
      return;
    const double s = std::max(time, 0.) / length;
    part = s * s * (3 - 2 * s);
    rate = 6 * s * (1 - s) / length;
  }
};

JointTarget swinging(const ParameterList& list, int n, double phase) {
  const Eigen::VectorXd middle = per_coordinate(list, "Value", n),
                        amplitude = per_coordinate(list, "Amplitude", n);
  const double turns = 2 * pi * list.get<double>("Frequency");
  const double ramp_time = list.get<double>("Ramp Time");
  return [=](double time) {
    const Ramp ramp(time, ramp_time);
    const double sine = std::sin(turns * time + phase);
    const double rate = ramp.part * turns * std::cos(turns * time + phase) + ramp.rate * sine;
    return TargetValue{middle + ramp.part * sine * amplitude, rate * amplitude};
  };
}

/// Phase of a wave at the joint, whose direction the list has.
double phase_of_wave(const ParameterList& list, const TargetSetting& setting) {
  const auto& way = list.get<ParameterArray<double>>("Direction");
  check_input(way.size() == setting.place.size(),
              "The \"Direction\" of the wave of the joint \"{}\" has {} numbers; give {}.",
              setting.joint, way.size(), setting.place.size());
  const Eigen::VectorXd along = Eigen::Map<const Eigen::VectorXd>(way.getRawPtr(), way.size());
  check_input(along.norm() > 0,
              "The \"Direction\" of the wave of the joint \"{}\" must not be zero.", setting.joint);
  return list.get<double>("Phase") -
         2 * pi * setting.place.dot(along.normalized()) / list.get<double>("Wavelength");
}

ParameterList swing_schema(int n) {
  ParameterList list;
  declare_per_coordinate(list, "Amplitude", n, 0, "Largest excursion [rad, m].");
  declare_per_coordinate(list, "Value", n, 0, "What it swings about [rad, m].");
  declare_required_positive(list, "Frequency", "Oscillations per second [1/s].");
  declare(list, "Phase", 0.0,
          "The target is value plus amplitude times sin(2 pi frequency time + phase) [rad].");
  declare_at_least(list, "Ramp Time", 0.0, 0.0,
                   "The amplitude grows from nothing until then [s]: a soft start.");
  return list;
}

ParameterList wave_schema(int n) {
  ParameterList list = swing_schema(n);
  declare_required_positive(list, "Wavelength",
                            "Joints lag behind by a whole oscillation for each of it that they are "
                            "farther along \"Direction\" [m].");
  declare_required<ParameterArray<double>>(
      list, "Direction", "Direction in which the wave travels, of any length [1].");
  return list;
}

ParameterList constant_schema(int n) {
  ParameterList list;
  declare_per_coordinate(list, "Value", n, 0, "The coordinates [rad, m]; 0 at the start.");
  return list;
}

ParameterList steady_schema(int n) {
  ParameterList list;
  declare_per_coordinate(list, "Value", n, 0, "The coordinates at time 0 [rad, m].");
  declare_per_coordinate(list, "Velocity", n, 0,
                         "Their rates [rad/s, m/s]: the target is value plus velocity times time.");
  return list;
}

JointTarget constant(const ParameterList& list, const TargetSetting& setting) {
  const TargetValue value{per_coordinate(list, "Value", setting.n),
                          Eigen::VectorXd::Zero(setting.n)};
  return [value](double) { return value; };
}

JointTarget steady(const ParameterList& list, const TargetSetting& setting) {
  const Eigen::VectorXd value = per_coordinate(list, "Value", setting.n),
                        rate = per_coordinate(list, "Velocity", setting.n);
  return [value, rate](double time) { return TargetValue{value + time * rate, rate}; };
}

ParameterList table_schema(int) {
  ParameterList list;
  declare_required<ParameterArray<double>>(list, "Times", "Ascending times [s], two or more.");
  declare_required<ParameterArray<double>>(
      list, "Values", "Coordinates at each time, straight lines between them [rad, m].");
  return list;
}

/// Straight lines between the rows of a table.
JointTarget from_table(const ParameterList& list, const TargetSetting& setting) {
  const auto& times = list.get<ParameterArray<double>>("Times");
  const auto& values = list.get<ParameterArray<double>>("Values");
  const int n = setting.n;
  check_input(times.size() >= 2 && std::is_sorted(times.begin(), times.end()) &&
                  std::adjacent_find(times.begin(), times.end()) == times.end(),
              "The \"Times\" of the target of the joint \"{}\" must ascend, two or more.",
              setting.joint);
  check_input(values.size() == times.size() * n,
              "The target of the joint \"{}\" has {} \"Values\", but {} times need {}.",
              setting.joint, values.size(), times.size(), times.size() * n);
  return [times, values, n](double time) {
    TargetValue target{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    const int last = static_cast<int>(times.size()) - 1;
    const auto above = std::upper_bound(times.begin(), times.end(), time);
    const int row = std::clamp(static_cast<int>(above - times.begin()) - 1, 0, last - 1);
    const double length = times[row + 1] - times[row];
    const double part = std::clamp((time - times[row]) / length, 0., 1.);
    for (int k = 0; k < n; ++k) {
      const double from = values[row * n + k], to = values[(row + 1) * n + k];
      target.q[k] = from + part * (to - from);
      if (time >= times[0] && time < times[last])
        target.rate[k] = (to - from) / length;
    }
    return target;
  };
}

}  // namespace

void declare_per_coordinate(ParameterList& list, const std::string& name, int n, double value,
                            const std::string& doc) {
  if (n == 1)
    declare(list, name, value, doc);
  else
    declare_vector(list, name, ParameterArray<double>(n, value), n, doc);
}

Eigen::VectorXd per_coordinate(const ParameterList& list, const std::string& name, int n) {
  if (n == 1)
    return Eigen::VectorXd::Constant(1, list.get<double>(name));
  const auto& values = list.get<ParameterArray<double>>(name);
  return Eigen::Map<const Eigen::VectorXd>(values.getRawPtr(), n);
}

void register_targets(TargetRegistry& targets) {
  targets.add("constant", "Stays.", constant_schema, constant);
  targets.add("constant rate", "Goes on evenly: a shaft that turns.", steady_schema, steady);
  targets.add("sinusoid", "Swings.", swing_schema,
              [](const ParameterList& list, const TargetSetting& setting) {
                return swinging(list, setting.n, list.get<double>("Phase"));
              });
  targets.add("table", "Follows a table, and stays before and after.", table_schema, from_table);
  targets.add("wave",
              "Swings, later farther along a direction: one wave goes through all joints that are "
              "given the same.",
              wave_schema, [](const ParameterList& list, const TargetSetting& setting) {
                return swinging(list, setting.n, phase_of_wave(list, setting));
              });
}

void declare_target(ParameterList& joint, int n, const TargetRegistry& targets) {
  declare_typed_sublist(joint, "Target",
                        "Target of the joint's coordinates: displacements along its axes, then "
                        "angles; all 0 at the start.",
                        targets.schemas(n), "constant");
}

JointTarget read_target(const ParameterList& joint, const TargetSetting& setting,
                        const TargetRegistry& targets) {
  const ParameterList& list = joint.sublist("Target");
  const auto& type = list.get<std::string>("Type");
  JointTarget target = targets.create(type, list, setting);
  const TargetValue start = target(0);
  check_input(
      start.q.size() == setting.n && start.rate.size() == setting.n,
      "The target \"{}\" of the joint \"{}\" gives {} coordinates and {} rates, not {}: its "
      "plug-in must be mended.",
      type, setting.joint, start.q.size(), start.rate.size(), setting.n);
  return target;
}

}  // namespace lockstep
