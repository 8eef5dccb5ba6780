#pragma once
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "articulated/joint_kind.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// How far the coordinates of a joint may go. Empty: as far as they like.
struct JointLimits {
  Eigen::VectorXd lower, upper;  ///< by coordinate [rad, m]; infinite: none
  /// Of a ball, from the start about any axis [rad]; infinite: none.
  double largest_turn = std::numeric_limits<double>::infinity();
  /// Whether coordinate k has one.
  bool bounds(int k) const {
    return std::isfinite(largest_turn) ||
           (lower.size() > 0 && (std::isfinite(lower[k]) || std::isfinite(upper[k])));
  }
  bool any() const { return lower.size() > 0 || std::isfinite(largest_turn); }
};

/// Declares them in the list of a joint of this kind.
template <int dim>
void declare_limits(ParameterList& joint, const JointKind& kind);
/// Of n coordinates alike.
void declare_limit_pair(ParameterList& list, int n);
/// Of a validated joint. Throws InputError.
template <int dim>
JointLimits read_limits(const ParameterList& joint, const std::string& name, const JointKind& kind);

/// One limit of one motion: `weights` times rates may not be below -`room` / dt.
struct RateLimit {
  Eigen::VectorXd weights;  ///< by rate of the joint
  double room = 0;          ///< [rad, m]
  bool turns = false;       ///< of an angle
};
/// At coordinates q, for a motion with about these rates over dt.
template <int dim>
std::vector<RateLimit> rate_limits(const JointKind& kind, const JointLimits& limits,
                                   const Eigen::VectorXd& q, const Eigen::VectorXd& rates,
                                   double dt);
/// Whether a coordinate is at one of its limits, or beyond; `k`: its number.
bool at_limit(const JointLimits& limits, const Eigen::VectorXd& q, int k);

}  // namespace lockstep
