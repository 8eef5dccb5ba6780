#pragma once
#include "liquid/surface/free_surface.hpp"

namespace lockstep {

/// Classifies cells by their centres and faces near the surface by `rule`, and numbers the
/// pressures. All of the fluid has this density. `surface` may be null or empty. Without a free
/// surface the fluid fills the domain. Pressure block and regions are not made here. Collective.
template <int dim>
MacGeometry<dim> make_geometry(const MacDomain<dim>& domain, double density,
                               const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                               const OpenFractionRule<dim>& rule,
                               const FreeSurface<dim>* free_surface = nullptr);

}  // namespace lockstep
