#pragma once
#include <algorithm>
#include <functional>

#include "mac/state/mac_geometry.hpp"

namespace lockstep {

template <int dim>
class GasPockets;

/// What pressures and faces know of the free surface at one instant. Above it is void: p = 0.
template <int dim>
struct FreeSurface {
  /// phi on all stored cells [m]: negative in the liquid, carried on into solids.
  const CellField* distance = nullptr;
  /// Part of the way from the centre of a wet cell to that of a dry neighbour at which the surface
  /// is, in (0, 1]. Local.
  std::function<double(int wet, int dry)> crossing;
  /// Pressures are no nearer to the surface than this [cells]: less costs iterations
  /// (docs/method.md).
  static constexpr double smallest_distance = 1e-5;
  /// True: p = 0 where the surface is. False: at the centre of the dry cell, first order.
  bool at_true_place = true;
  GasPockets<dim>* gas = nullptr;  ///< null: no void is closed

  bool wet(int cell) const { return (*distance)[cell] < 0; }
  /// w of the face between them, h over the distance of the pressure from the surface.
  double closeness(int wet, int dry, double least = 0) const {
    return at_true_place ? 1 / std::max({crossing(wet, dry), smallest_distance, least}) : 1;
  }
};

/// What is not below the free surface is void. Local.
template <int dim>
void empty_dry_cells(const TiledGrid<dim>& grid, const FreeSurface<dim>& free_surface,
                     std::vector<CellState>& cells);
/// Pressures beside the void are as near to it as the free surface is: of owned faces, and of the
/// upper ones of owned cells. Local.
template <int dim>
void set_closeness_to_void(const MacDomain<dim>& domain, const FreeSurface<dim>& free_surface,
                           MacGeometry<dim>& geometry);

}  // namespace lockstep
