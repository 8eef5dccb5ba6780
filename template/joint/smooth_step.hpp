#pragma once
#include "articulated/joint_target.hpp"

/// Parameters of the target for n coordinates, and the target made of them.
lockstep::ParameterList smooth_step_parameters(int n);
lockstep::JointTarget smooth_step(const lockstep::ParameterList& list,
                                  const lockstep::TargetSetting& setting);
