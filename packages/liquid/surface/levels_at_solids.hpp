#pragma once
#include "interfaces/liquid.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// See LiquidFluid::levels_at_solids. `distance` is phi of the same instant as the geometry;
/// without gravity no level is known. Collective.
template <int dim>
std::vector<WaterLevel> find_levels_at_solids(const MacDomain<dim>& domain,
                                              const MacGeometry<dim>& geometry,
                                              const CellField& distance, const Point<dim>& gravity);

}  // namespace lockstep
