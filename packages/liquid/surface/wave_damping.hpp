#pragma once
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Filter of the shortest waves on the interface: the pressure acts where the surface will be a
/// moment later, in so far as its motion varies from cell to cell. On a surface across the axes the
/// velocity that moves it is not quite the one that its pressure works on, so that waves of two to
/// four cells grow, by e in ten times sqrt(h/g) at worst; damped, a wave of number k loses
/// (kh)^5/16 of its height in the time sqrt(h/g). With surface tension g stands for the restoring
/// acceleration of waves of number 1/h, g + sigma / (rho h^2).
///
/// Returns the distance by which the pressure's phi is ahead [m], 0 where a surface of solids is
/// near and where the liquid's moves as a plane. `distance`: phi; `velocity`: extended into the
/// air, as marked in `geometry`; both with valid halos. `gravity`: the acceleration g [m/s^2], not
/// 0. Collective.
template <int dim>
CellField short_wave_filter(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                            const CellField& distance, const FaceField<dim>& velocity,
                            double gravity, double dt);

}  // namespace lockstep
