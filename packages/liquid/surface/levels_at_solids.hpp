#pragma once
#include "interfaces/liquid.hpp"
#include "liquid/surface/free_surface.hpp"

namespace lockstep {

/// See LiquidFluid::levels_at_solids. The free surface is that of the same instant as the
/// geometry; of it phi and the gas are used. Without gravity no level is known. Collective.
template <int dim>
std::vector<WaterLevel> find_levels_at_solids(const MacDomain<dim>& domain,
                                              const MacGeometry<dim>& geometry,
                                              const FreeSurface<dim>& free_surface,
                                              const Point<dim>& gravity);

}  // namespace lockstep
