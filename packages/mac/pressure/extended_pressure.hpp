#pragma once
#include <functional>

#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Extends a pressure of the last step to the cells that hold fluid now: those that had none take
/// the mean of their neighbours, front after front, on top of the hydrostatic pressure. `before`
/// marks the cells that had one, `gradient` is the hydrostatic gradient (rho_0 g, times dt for p̂),
/// which is less in cells of gas (MacGeometry::lightness).
/// Ghost values count and are set. Collective.
template <int dim>
CellField extended_pressure(const MacDomain<dim>& domain, const std::vector<CellState>& now,
                            const std::vector<CellState>& before, CellField pressure,
                            const Point<dim>& gradient, const std::vector<float>& lightness = {});

/// Bounds a pressure of the last step where the surface has come so near to it (distance factor w >
/// 10) that the flux it drives through the face would diverge: takes it from the line between the
/// cell opposite and the surface, which is exact for hydrostatic pressure. `at_surface`: the
/// pressure there, of a wet cell and its dry neighbour at the end of an axis. Ghost values must be
/// valid, and are set. Collective.
template <int dim>
void bound_beside_air(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                      const std::function<double(int wet, int dry, int axis, int end)>& at_surface,
                      CellField& pressure);

}  // namespace lockstep
