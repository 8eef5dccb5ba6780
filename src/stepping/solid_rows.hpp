#pragma once
#include <string>

#include "stepping/step/time_scheme.hpp"

namespace lockstep {

/// True for springs, ropes and mooring lines, which have no surface.
bool is_line(const SolidDescription& solid);

/// A row a solid, for --explain: mass, volume, box in metres and in cells, elements of its surface,
/// whether the fluid is inside of it, the part of its box outside of the domain, the longest stable
/// step of its kind. `surface`: that of the solids at the present positions. Local.
template <int dim>
std::string solid_rows(const Components<dim>& components, const SurfaceSnapshot<dim>& surface);

/// A line for each solid that is likely a mistake: smaller than two cells, outside of the domain,
/// free to move and by a hundredth of its box outside, lighter than the liquid and under its
/// surface at the start, more than two cells away from what is attached to it. Collective. Another
/// one where a solid is free to leave a periodic domain and does not come back as fluid does.
template <int dim>
std::string solid_warnings(const Components<dim>& components, const SurfaceSnapshot<dim>& surface);

}  // namespace lockstep
