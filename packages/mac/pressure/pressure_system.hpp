#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Components of the fluid cells joined by open faces, numbered by their first cell in the lattice,
/// so that the numbers do not depend on the ranks. Collective.
template <int dim>
PressureRegions find_regions(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry);

/// rhs = minus the outflow of each fluid cell through free and prescribed faces [m^dim/s]. The halo
/// of `velocity` must be valid.
template <int dim>
void outflow_deficit(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                     const FaceField<dim>& velocity, Vector& rhs);

/// Returns the pressures on owned cells and their neighbours; zero elsewhere. Collective.
template <int dim>
CellField pressure_field(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                         const Vector& scaled_pressure);

/// velocity -= rho^-1 G p̂ on owned free faces.
template <int dim>
void subtract_gradient(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                       const CellField& scaled_pressure, FaceField<dim>& velocity);

/// Impulse of walls and inflows on the fluid through their pressure, which is that of the cell
/// beside them; open sides have none (p = 0). Collective.
template <int dim>
Momentum<dim> side_pressure_impulse(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                    const Vector& scaled_pressure);

}  // namespace lockstep
