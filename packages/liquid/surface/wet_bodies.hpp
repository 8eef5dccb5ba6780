#pragma once
#include "interfaces/liquid.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// See LiquidFluid::wet_bodies. `distance` is phi of the same instant as the geometry; without
/// gravity nothing floats, and nothing is found. Collective.
template <int dim>
std::vector<WetBody<dim>> find_wet_bodies(const MacDomain<dim>& domain,
                                          const MacGeometry<dim>& geometry,
                                          const CellField& distance, const Point<dim>& gravity);

}  // namespace lockstep
