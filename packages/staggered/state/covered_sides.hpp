#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// True if a closed solid goes on behind a side of the domain (end 0 lower, 1 upper), by more than
/// a tenth of a cell: less is an overlap in contact. Local.
template <int dim>
bool goes_through(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface, int solid,
                  int axis, int end);

/// Faces of cut cells on walls and inflows that a solid covers in part, which is on its way through
/// the side: their control volumes, behind those of `coupled`. The covered part moves with the
/// solid and takes the pressure there; were it still, what the solid pushes into the last cells
/// between body and side would have no way out but gaps that close. A solid that only touches a
/// wall displaces nothing.
template <int dim>
void add_covered_sides(const MacDomain<dim>& domain, const OpenFractionRule<dim>& rule,
                       MacGeometry<dim>& geometry);

}  // namespace lockstep
