#include "smooth_step.hpp"

#include <algorithm>
using namespace lockstep;

ParameterList smooth_step_parameters(int n) {
  ParameterList list;
  declare_per_coordinate(list, "Value", n, 0, "Coordinates at the end [rad, m].");
  declare_required_positive(list, "Duration", "Time that the way takes [s].");
  return list;
}

/// Value s^2 (3 - 2 s), whose rate has no jump.
JointTarget smooth_step(const ParameterList& list, const TargetSetting& setting) {
  const Eigen::VectorXd value = per_coordinate(list, "Value", setting.n);
  const double duration = list.get<double>("Duration");
  return [value, duration](double time) {
    const double s = std::clamp(time / duration, 0., 1.);
    return TargetValue{s * s * (3 - 2 * s) * value, 6 * s * (1 - s) / duration * value};
  };
}
