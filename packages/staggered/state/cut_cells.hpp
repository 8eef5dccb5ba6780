#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Finds the cells with a pressure through which surfaces of soft bodies pass: owned ones and those
/// below owned faces, once each. To be called when pressures have numbers. Local.
template <int dim>
std::vector<CutCell<dim>> find_cut_cells(const MacDomain<dim>& domain,
                                         const MacGeometry<dim>& geometry);

}  // namespace lockstep
