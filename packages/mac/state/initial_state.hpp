#pragma once
#include "parameters/field_formula.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// The velocity at the start at all stored faces, from the parameter "Velocity" of the fluid.
/// Throws InputError if a formula is not finite somewhere. Local.
template <int dim>
FaceField<dim> initial_velocity(const TiledGrid<dim>& grid, const FieldFormula<dim>& formula);

}  // namespace lockstep
