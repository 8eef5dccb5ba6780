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

JointTarget swinging(const Eigen::VectorXd& middle, const Eigen::VectorXd& amplitude,
                     double frequency, double phase, double ramp_time) {
  const double turns = 2 * pi * frequency;
  return [=](double time) {
    const Ramp ramp(time, ramp_time);
    const double sine = std::sin(turns * time + phase);
    const double rate = ramp.part * turns * std::cos(turns * time + phase) + ramp.rate * sine;
    return TargetValue{middle + ramp.part * sine * amplitude, rate * amplitude};
  };
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

/// Straight lines between the rows of a table.
JointTarget from_table(const ParameterList& list, int n, const std::string& name) {
  const auto& times = list.get<ParameterArray<double>>("Times");
  const auto& values = list.get<ParameterArray<double>>("Values");
  check_input(times.size() >= 2 && std::is_sorted(times.begin(), times.end()) &&
                  std::adjacent_find(times.begin(), times.end()) == times.end(),
              "The \"Times\" of the target of the joint \"{}\" must ascend, two or more.", name);
  check_input(values.size() == times.size() * n,
              "The target of the joint \"{}\" has {} \"Values\", but {} times need {}.", name,
              values.size(), times.size(), times.size() * n);
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

void declare_target(ParameterList& joint, int n) {
  ParameterList constant, steady, table;
  declare_per_coordinate(constant, "Value", n, 0, "The coordinates [rad, m]; 0 at the start.");
  declare_per_coordinate(steady, "Value", n, 0, "The coordinates at time 0 [rad, m].");
  declare_per_coordinate(steady, "Velocity", n, 0,
                         "Their rates [rad/s, m/s]: the target is value plus velocity times time.");
  declare_required<ParameterArray<double>>(table, "Times", "Ascending times [s], two or more.");
  declare_required<ParameterArray<double>>(
      table, "Values", "Coordinates at each time, straight lines between them [rad, m].");
  ParameterList wave = swing_schema(n);
  declare_required_positive(wave, "Wavelength",
                            "Joints lag behind by a whole oscillation for each of it that they are "
                            "farther along \"Direction\" [m].");
  declare_required<ParameterArray<double>>(
      wave, "Direction", "Direction in which the wave travels, of any length [1].");
  declare_typed_sublist(joint, "Target",
                        "Target of the joint's coordinates: displacements along its axes, then "
                        "angles; all 0 at the start.",
                        {{"constant", "Stays.", constant},
                         {"constant rate", "Goes on evenly: a shaft that turns.", steady},
                         {"sinusoid", "Swings.", swing_schema(n)},
                         {"table", "Follows a table, and stays before and after.", table},
                         {"wave",
                          "Swings, later farther along a direction: one wave goes through "
                          "all joints that are given the same.",
                          wave}},
                        "constant");
}

JointTarget read_target(const ParameterList& joint, int n,
                        const std::function<double(const ParameterArray<double>&)>& place,
                        const std::string& name) {
  const ParameterList& list = joint.sublist("Target");
  const auto& type = list.get<std::string>("Type");
  if (type == "table")
    return from_table(list, n, name);
  if (type == "constant") {
    const Eigen::VectorXd value = per_coordinate(list, "Value", n);
    return [value, n](double) { return TargetValue{value, Eigen::VectorXd::Zero(n)}; };
  }
  if (type == "constant rate") {
    const Eigen::VectorXd value = per_coordinate(list, "Value", n),
                          rate = per_coordinate(list, "Velocity", n);
    return [value, rate](double time) { return TargetValue{value + time * rate, rate}; };
  }
  double phase = list.get<double>("Phase");
  if (type == "wave")
    phase -= 2 * pi * place(list.get<ParameterArray<double>>("Direction")) /
             list.get<double>("Wavelength");
  return swinging(per_coordinate(list, "Value", n), per_coordinate(list, "Amplitude", n),
                  list.get<double>("Frequency"), phase, list.get<double>("Ramp Time"));
}

}  // namespace lockstep
