#pragma once
#include "interfaces/momentum.hpp"
#include "liquid/surface/free_surface.hpp"

namespace lockstep {

/// Curvature of the surface where it crosses the line from the centre of a wet cell to that of the
/// dry one beside it, at the part `place` of the way; positive where the liquid is convex, at most
/// (dim - 1) / h in size [1/m]: that of the paraboloid through the places around at which it
/// crosses such lines. Beyond the sides of the domain the surface goes on at their contact angle:
/// one that meets a side at another is bent there, and so pulled to it. Local.
template <int dim>
double curvature(const MacDomain<dim>& domain, const CellField& phi, int wet, int axis, int side,
                 double place);

/// Explicit capillary force: surface tension sigma [N/m] is a known pressure jump p_s = sigma kappa
/// where the surface crosses a face (ghost fluid). Adds its change over dt to the velocity of owned
/// faces; the halo is not set. Surfaces that close in themselves are not moved as a whole. Returns
/// its impulse on the liquid, of this rank. Collective.
template <int dim>
Momentum<dim> push_surface(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                           const FreeSurface<dim>& surface, double tension, double dt,
                           FaceField<dim>& velocity);

}  // namespace lockstep
