#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Faces of cut cells on walls and inflows that a solid covers in part, which is on its way through
/// the side: their control volumes, behind those of `coupled`. The covered part moves with the
/// solid and takes the pressure there; were it still, what the solid pushes into the last cells
/// between body and side would have no way out but gaps that close.
template <int dim>
void add_covered_sides(const MacDomain<dim>& domain, const OpenFractionRule<dim>& rule,
                       MacGeometry<dim>& geometry);

}  // namespace lockstep
