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

/// From validated lists (see above) and the names of the joints. Throws InputError. Local.
template <int dim>
std::shared_ptr<Articulation<dim>> read_joints(const ParameterList& shared,
                                               const NamedLists& joints,
                                               const JointSetting<dim>& setting);

}  // namespace lockstep
