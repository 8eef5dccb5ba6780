#pragma once
#include <memory>

#include "articulated/joint_kind.hpp"
#include "articulated/joint_target.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Types of joints by name. The lists of a type are `joint_parameters` and what it adds to them.
template <int dim>
using JointRegistry = RegistryOf<ParameterList(const TargetRegistry&),
                                 std::unique_ptr<JointKind<dim>>(const ParameterList&)>;

/// Types that joints and their targets may have.
template <int dim>
struct JointTypes {
  std::shared_ptr<const JointRegistry<dim>> joints;
  std::shared_ptr<const TargetRegistry> targets;
};

/// Parameters of all joints with such degrees of freedom: what they connect, where, their control
/// and limits.
template <int dim>
ParameterList joint_parameters(const JointFreedom& freedom, const TargetRegistry& targets);

/// Registers the types that ship.
template <int dim>
void register_joints(JointRegistry<dim>& joints);

}  // namespace lockstep
