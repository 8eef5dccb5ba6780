#pragma once
#include <memory>
#include <vector>

#include "articulated/articulation.hpp"
#include "interfaces/registries.hpp"

namespace lockstep {

/// Schemas of the kinds of joints.
template <int dim>
std::vector<TypedSchema> joint_schemas();
/// Schema of what all joints share.
ParameterList articulation_parameters();

/// Reads the joints from validated lists (see above) and their names. Throws InputError. Local.
template <int dim>
std::shared_ptr<Articulation<dim>> read_joints(const ParameterList& shared,
                                               const NamedLists& joints,
                                               const JointSetting<dim>& setting);

}  // namespace lockstep
