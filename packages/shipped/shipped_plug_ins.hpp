#pragma once
#include <memory>

#include "interfaces/registries.hpp"
#include "liquid/common/interface_model.hpp"

namespace lockstep {

/// All models of a liquid's surface that ship with Lockstep, for "mac". A driver with its own adds
/// them to what this returns.
template <int dim>
std::shared_ptr<InterfaceRegistry<dim>> shipped_interface_models();

/// All plug-ins that ship with Lockstep. A driver with its own adds them to what this returns.
/// `interfaces`: those that "mac" may choose from; null: the shipped ones.
template <int dim>
Registries<dim> shipped_plug_ins(
    std::shared_ptr<const InterfaceRegistry<dim>> interfaces = nullptr);

}  // namespace lockstep
