#pragma once
#include <functional>
#include <string>

#include "base/types.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Coordinates that a joint is asked to take, and their rates.
struct TargetValue {
  Eigen::VectorXd q, rate;
};
/// Target of a joint by the time [s].
using JointTarget = std::function<TargetValue(double time)>;

/// Properties of a joint that its target may know.
struct TargetSetting {
  int n = 1;              ///< number of coordinates for which the target is
  std::string joint;      ///< name, for messages
  Eigen::VectorXd place;  ///< place of the joint at the start, in space [m]
};

/// Types of targets by name. What a scene says of a target depends on the number of coordinates.
using TargetRegistry =
    RegistryOf<ParameterList(int n), JointTarget(const ParameterList&, const TargetSetting&)>;

/// Registers the types that ship.
void register_targets(TargetRegistry& targets);
/// Declares the list "Target" of a joint with n coordinates.
void declare_target(ParameterList& joint, int n, const TargetRegistry& targets);
/// Reads the target of a validated joint. Throws InputError.
JointTarget read_target(const ParameterList& joint, const TargetSetting& setting,
                        const TargetRegistry& targets);

/// Values for each of n coordinates: a number for one, an array for several.
void declare_per_coordinate(ParameterList& list, const std::string& name, int n, double value,
                            const std::string& doc);
Eigen::VectorXd per_coordinate(const ParameterList& list, const std::string& name, int n);

}  // namespace lockstep
