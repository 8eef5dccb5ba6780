#pragma once
#include "geometry/moving_surface.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Pressures of a step, times its length.
template <int dim>
struct PressureScales {
  Point<dim> at_rest =
      Point<dim>::Zero();  ///< gradient that gravity makes in fluid at rest [Pa s/m]
  double inertia = 0;      ///< pressure over the square of a solid's speed [kg/m^dim s]
  double friction = 0;     ///< pressure over its speed [Pa s^2/m]
};

/// Carries the pressure of the last step along with the rigid closed solids that have moved since:
/// what lies around one goes by the mean displacement of its surface, less so farther off, and from
/// its own length on not at all. What gravity makes in fluid at rest stays where it is, and
/// no pressure changes by more than the solid's motion makes: a load that fluid bears does not go
/// along. `cells`: states of cells when the pressure was found; those in and beside such solids
/// take a value continued from the fluid and count as fluid afterwards. Halos must be valid, and
/// are so afterwards. Collective.
///
/// A pressure that stayed behind would be off by dt V . grad p, which is odd in time: with
/// viscosity it lifts a body that moves along a shear (docs/method.md, pressure correction).
template <int dim>
void carry_pressure(const MacDomain<dim>& domain, const MovingSurface<dim>& surface,
                    const PressureScales<dim>& scales, std::vector<CellState>& cells,
                    CellField& pressure);

}  // namespace lockstep
