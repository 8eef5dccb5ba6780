#pragma once
#include "deformable/materials/material.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// Laws by name, made from the list "Material" of a body; the first is the default.
template <int dim>
using MaterialRegistry = Registry<Material<dim>>;

/// The parameters of Hooke's law, "Young's Modulus" and "Poisson's Ratio", for laws that have these
/// constants among theirs, and their values in a validated list.
ParameterList elastic_constants();
LameConstants read_elastic_constants(const ParameterList& material);

/// Registers the laws that ship.
template <int dim>
void register_materials(MaterialRegistry<dim>& materials);

/// The laws that ship, for bodies of programs that know no others.
template <int dim>
const MaterialRegistry<dim>& shipped_materials();

}  // namespace lockstep
