#pragma once
#include <algorithm>
#include <functional>

#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

template <int dim>
class GasBubbles;

/// The free surface at one instant, as pressures and faces see it: above it a gas, or ghost fluid
/// with p = 0.
template <int dim>
struct FreeSurface {
  /// phi on all stored cells [m]: negative in the liquid, extrapolated into solids.
  const CellField* distance = nullptr;
  /// Curvature where the surface, with the shift of the short-wave filter, crosses the line from
  /// the centre of a wet cell to that of the dry one beside it, at the part `place` of the way
  /// [1/m]; empty without tension. Local.
  std::function<double(int wet, int axis, int side, double place)> curvature;
  /// Part of the way from the centre of a wet cell to that of a dry neighbour at which the surface
  /// is, in (0, 1]. Local.
  std::function<double(int wet, int dry)> crossing;
  /// Pressures are no nearer to the surface than this [cells]: less costs iterations
  /// (docs/method.md).
  static constexpr double smallest_distance = 1e-5;
  /// True: p = 0 where the surface is. False: at the centre of the dry cell, first order.
  bool at_true_place = true;
  GasBubbles<dim>* gas = nullptr;  ///< null: no air is closed in

  double gas_density = 0;  ///< density of the fluid above it [kg/m^dim]; 0: air at p = 0

  bool has_gas() const { return gas_density > 0; }
  bool wet(int cell) const { return (*distance)[cell] < 0; }
  /// Distance factor w = 1/theta of the face between them, h over the distance of the pressure from
  /// the surface.
  double distance_factor(int wet, int dry, double least = 0) const {
    return at_true_place ? 1 / std::max({crossing(wet, dry), smallest_distance, least}) : 1;
  }
};

/// Marks cells that are not below the free surface as air. Local.
template <int dim>
void empty_dry_cells(const TiledGrid<dim>& grid, const FreeSurface<dim>& free_surface,
                     std::vector<CellState>& cells);
/// Sets the density of faces beside gas, that of the liquid being the regular one: the mean over
/// the way between the pressures on both sides, rho = theta rho_liquid + (1 - theta) rho_gas, for
/// which a pressure that is linear in each phase is exact (ghost fluid). Local.
template <int dim>
void set_phase_densities(const MacDomain<dim>& domain, const FreeSurface<dim>& free_surface,
                         MacGeometry<dim>& geometry);
/// Sets the distance factor 1/theta of faces beside air (ghost fluid: p = 0 at the free surface),
/// for owned faces and the upper ones of owned cells. Local.
template <int dim>
void set_distance_factor_to_air(const MacDomain<dim>& domain, const FreeSurface<dim>& free_surface,
                                MacGeometry<dim>& geometry);

}  // namespace lockstep
