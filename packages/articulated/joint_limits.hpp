#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "articulated/joint_kind.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Range of the coordinates of a joint. Empty: unlimited.
struct JointLimits {
  Eigen::VectorXd lower, upper;  ///< by coordinate [rad, m]; infinite: none
  /// Largest turn of a ball joint from the start about any axis [rad]; infinite: no limit.
  double largest_turn = std::numeric_limits<double>::infinity();
  /// True if coordinate k has a limit.
  bool bounds(int k) const {
    return std::isfinite(largest_turn) ||
           (lower.size() > 0 && (std::isfinite(lower[k]) || std::isfinite(upper[k])));
  }
  bool any() const { return lower.size() > 0 || std::isfinite(largest_turn); }
};

/// Declares the limits in the list of a joint with such coordinates.
void declare_limits(ParameterList& joint, const JointFreedom& freedom);
/// Declares the limits of n coordinates alike.
void declare_limit_pair(ParameterList& list, int n);
/// Reads the limits of a validated joint. Throws InputError.
JointLimits read_limits(const ParameterList& joint, const std::string& name,
                        const JointFreedom& freedom);

/// One limit of one motion: `weights` times rates may not be below -`room` / dt.
struct RateLimit {
  Eigen::VectorXd weights;  ///< by rate of the joint
  double room = 0;          ///< [rad, m]
  bool turns = false;       ///< true for an angle
};
/// Returns the limits at coordinates q, for a motion with about these rates over dt.
std::vector<RateLimit> rate_limits(const JointFreedom& freedom, const JointLimits& limits,
                                   const Eigen::VectorXd& q, const Eigen::VectorXd& rates,
                                   double dt);
/// True if coordinate k is at one of its limits, or beyond.
bool at_limit(const JointLimits& limits, const Eigen::VectorXd& q, int k);

}  // namespace lockstep
