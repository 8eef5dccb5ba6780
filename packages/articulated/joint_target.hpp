#pragma once
#include <functional>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Coordinates that a joint is asked to take, and their rates.
struct TargetValue {
  Eigen::VectorXd q, rate;
};
/// Target of a joint by the time [s].
using JointTarget = std::function<TargetValue(double time)>;

/// Declares the list "Target" of a joint with n coordinates.
void declare_target(ParameterList& joint, int n);
/// Reads the target of a validated joint; `place`: its point at the start along the way that waves
/// go [m].
JointTarget read_target(const ParameterList& joint, int n,
                        const std::function<double(const ParameterArray<double>&)>& place,
                        const std::string& name);

/// Values for each of n coordinates: a number for one, an array for several.
void declare_per_coordinate(ParameterList& list, const std::string& name, int n, double value,
                            const std::string& doc);
Eigen::VectorXd per_coordinate(const ParameterList& list, const std::string& name, int n);

}  // namespace lockstep
