#include "coupling/automatic_coupling.hpp"

#include <fmt/format.h>

namespace lockstep {

namespace {
/// Thickness of closed solids, in cells, from which fluxes through cut cells tell its two sides
/// apart: between centres of cells on both sides lies one that is inside.
constexpr double least_thickness = 2;
/// Density of a solid over the fluid's from which on fluxes serve. Nothing is lumped on a body, so
/// that a ball of 1e-4 and less gains energy where it leaves the water, one of 1e-2 under another
/// body creeps at 6e-6 sqrt(g L), and a solve for an implicit solid of 1e-3 did not converge in a
/// step of many of its periods (docs/method.md, "Contact"; study contact-stability).
constexpr double least_density = 2e-2;
}  // namespace

template <int dim>
double thickness(const SurfaceSnapshot<dim>& surface, int solid) {
  const SurfaceMesh<dim> mesh = surface.mesh_of_solid(solid);
  const double of_plate =
      2 * volume_properties<dim>(mesh).measure / shell_properties<dim>(mesh).measure;
  const double extent = surface.own_bounds(solid).sizes().minCoeff();
  constexpr double nearly = 0.8;  // part of a ball's or a cube's, whose ratio is extent / (2 dim)
  return of_plate >= nearly * extent / dim ? extent : of_plate;
}

template <int dim>
CouplingChoice automatic_coupling(const SurfaceSnapshot<dim>& surface, double spacing,
                                  double density) {
  const std::string whole = "mixed face";
  bool any_closed = false;
  for (std::size_t s = 0; s < surface.solids().size(); ++s) {
    const SolidDescription& solid = surface.solids()[s];
    if (!solid.closed || solid.simplex_begin == solid.simplex_end)
      continue;  // a shell, or a body that the fluid does not see
    any_closed = true;
    if (!solid.prescribed && solid.density < least_density * density)
      return {whole, fmt::format("\"{}\" is {:.2g} times as dense as the fluid", solid.name,
                                 solid.density / density)};
    const double cells = thickness(surface, static_cast<int>(s)) / spacing;
    if (cells < least_thickness)
      return {whole, fmt::format("\"{}\" is {:.3g} cells thick", solid.name, cells)};
  }
  return any_closed ? CouplingChoice{"flux", "closed solids are not thin"}
                    : CouplingChoice{whole, "no solid is closed"};
}

template double thickness<2>(const SurfaceSnapshot<2>&, int);
template double thickness<3>(const SurfaceSnapshot<3>&, int);
template CouplingChoice automatic_coupling<2>(const SurfaceSnapshot<2>&, double, double);
template CouplingChoice automatic_coupling<3>(const SurfaceSnapshot<3>&, double, double);

}  // namespace lockstep
