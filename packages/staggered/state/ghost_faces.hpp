#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// The upper faces of owned cells may be ghosts; those at open sides can be told from the state.
/// Local.
template <int dim>
void complete_ghost_faces(const MacDomain<dim>& domain, MacGeometry<dim>& geometry);
/// The open fractions of ghost faces, if any rank has partly open ones along an axis. Collective.
template <int dim>
void share_open_fractions(const MacDomain<dim>& domain, MacGeometry<dim>& geometry);

}  // namespace lockstep
