#pragma once
#include <memory>

#include "articulated/articulation.hpp"
#include "articulated/joint_registry.hpp"
#include "interfaces/registries.hpp"

namespace lockstep {

/// Schema of what all joints share.
ParameterList articulation_parameters();

/// Reads the joints from validated lists and their names. Throws InputError. Local.
template <int dim>
std::shared_ptr<Articulation<dim>> read_joints(const ParameterList& shared,
                                               const NamedLists& joints,
                                               const JointSetting<dim>& setting,
                                               const JointTypes<dim>& types);

}  // namespace lockstep
