#include "articulated/joint_limits.hpp"

#include <cmath>
#include <limits>

#include "articulated/joint_control.hpp"
#include "base/errors.hpp"
#include "motion/list_values.hpp"

namespace lockstep {

namespace {

const std::string limits_list = "Limits";
constexpr double none = std::numeric_limits<double>::infinity();

/// Returns the bounds of all coordinates, where a coordinate's own list comes before that of all;
/// `absent` where there is none.
Eigen::VectorXd bounds(const ParameterList& joint, const std::string& name, const std::string& side,
                       int n, double absent) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(n, absent);
  const ParameterList& shared = joint.sublist(limits_list);
  if (n == 1) {
    if (shared.isParameter(side))
      values[0] = shared.get<double>(side);
    return values;
  }
  if (shared.isParameter(side)) {
    const auto& all = shared.get<ParameterArray<double>>(side);
    check_input(all.size() == n,
                "\"{}\" of the limits of the joint \"{}\" has {} numbers; give {}.", side, name,
                all.size(), n);
    values = Eigen::Map<const Eigen::VectorXd>(all.getRawPtr(), n);
  }
  for (int k = 0; k < n; ++k) {
    const std::string own = coordinate_list(k);
    if (joint.isSublist(own) && joint.sublist(own).sublist(limits_list).isParameter(side))
      values[k] = joint.sublist(own).sublist(limits_list).get<double>(side);
  }
  return values;
}

}  // namespace

void declare_limits(ParameterList& joint, const JointFreedom& freedom) {
  const int n = freedom.n_coordinates();
  if (freedom.rotation_vector) {
    ParameterList& limits = declare_list(joint, limits_list, "What stops it.");
    declare_optional<double>(limits, "Upper",
                             "How far it may turn from where it is at the start, about whatever "
                             "axis [rad]. Absent: as far as it likes.");
    set_between(limits, "Upper", 0, 3.14159);
    return;
  }
  declare_limit_pair(joint, n);
}

void declare_limit_pair(ParameterList& list, int n) {
  ParameterList& limits = declare_list(list, limits_list, "What stops it.");
  for (const auto& [side, least] : {std::pair{"Lower", "least"}, {"Upper", "largest"}}) {
    const std::string doc =
        fmt::format("{} value of {} [rad, m]; 0 at the start. Absent: none.", least,
                    n == 1 ? "the coordinate" : "each of the coordinates");
    if (n == 1)
      declare_optional<double>(limits, side, doc);
    else
      declare_optional<ParameterArray<double>>(limits, side, doc);
  }
}

JointLimits read_limits(const ParameterList& joint, const std::string& name,
                        const JointFreedom& freedom) {
  JointLimits limits;
  if (freedom.rotation_vector) {
    const ParameterList& list = joint.sublist(limits_list);
    if (list.isParameter("Upper"))
      limits.largest_turn = list.get<double>("Upper");
    check_input(limits.largest_turn > 0,
                "The joint \"{}\" may turn by 0 at most, about any axis; make it a weld.", name);
    return limits;
  }
  const int n = freedom.n_coordinates();
  if (n == 0)
    return limits;
  const Eigen::VectorXd lowest = bounds(joint, name, "Lower", n, -none);
  const Eigen::VectorXd highest = bounds(joint, name, "Upper", n, none);
  if (lowest.maxCoeff() == -none && highest.minCoeff() == none)
    return limits;
  limits.lower = lowest;
  limits.upper = highest;
  for (int k = 0; k < n; ++k) {
    const double lower = limits.lower[k], upper = limits.upper[k];
    check_input(lower <= upper, "The joint \"{}\" has its lower limit {} above its upper limit {}.",
                name, lower, upper);
    check_input(lower <= 0 && upper >= 0,
                "The joint \"{}\" starts at 0, which is {} its {} limit {}; limits count from "
                "where the bodies are at the start.",
                name, lower > 0 ? "below" : "above", lower > 0 ? "lower" : "upper",
                lower > 0 ? lower : upper);
  }
  return limits;
}

std::vector<RateLimit> rate_limits(const JointFreedom& freedom, const JointLimits& limits,
                                   const Eigen::VectorXd& q, const Eigen::VectorXd& rates,
                                   double dt) {
  std::vector<RateLimit> all;
  if (std::isfinite(limits.largest_turn)) {
    // The tangent of the bound where the motion leads: |q| changes as its part along q does.
    const Eigen::VectorXd there = q + dt * rates;
    if (there.norm() == 0)
      return all;
    const Eigen::VectorXd way = there / there.norm();
    all.push_back({-way, limits.largest_turn - way.dot(q), true});
    return all;
  }
  for (Eigen::Index k = 0; k < limits.lower.size(); ++k) {
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(q.size(), k);
    if (std::isfinite(limits.lower[k]))
      all.push_back({unit, q[k] - limits.lower[k], k >= freedom.displacements});
    if (std::isfinite(limits.upper[k]))
      all.push_back({-unit, limits.upper[k] - q[k], k >= freedom.displacements});
  }
  return all;
}

bool at_limit(const JointLimits& limits, const Eigen::VectorXd& q, int k) {
  constexpr double close = 1e-6;
  if (std::isfinite(limits.largest_turn))
    return q.norm() >= limits.largest_turn - close;
  return limits.lower.size() > 0 &&
         (q[k] <= limits.lower[k] + close || q[k] >= limits.upper[k] - close);
}

}  // namespace lockstep
