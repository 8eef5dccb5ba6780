#pragma once
#include "articulated/joint_registry.hpp"

namespace lockstep::test {

/// The types of joints that ship.
template <int dim>
JointRegistry<dim> shipped_joints() {
  JointRegistry<dim> joints("joint");
  register_joints<dim>(joints);
  return joints;
}

template <int dim>
std::shared_ptr<const JointKind<dim>> joint_kind(const std::string& name) {
  return shipped_joints<dim>().create(name, ParameterList());
}

}  // namespace lockstep::test
