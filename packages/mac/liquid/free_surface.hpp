#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "mac/state/mac_geometry.hpp"

namespace lockstep {

/// What pressures and faces know of the free surface at one instant. Above it is void: p = 0.
template <int dim>
struct FreeSurface {
  /// phi on all stored cells [m]: negative in the liquid, carried on into solids.
  const CellField* distance = nullptr;
  /// Part of the way from the centre of a wet cell to that of a dry neighbour at which the surface
  /// is, in (0, 1]. Local.
  std::function<double(int wet, int dry)> crossing;
  double smallest_distance = 0.01;  ///< of a pressure from the surface [cells]
  /// True: p = 0 where the surface is. False: at the centre of the dry cell, first order.
  bool at_true_place = true;

  bool wet(int cell) const { return (*distance)[cell] < 0; }
  /// w of the face between them, h over the distance of the pressure from the surface. A multiple
  /// of 2^-13 and no more than 100: of such numbers single precision adds six exactly, so that all
  /// who use A have the same.
  double closeness(int wet, int dry) const {
    if (!at_true_place)
      return 1;
    return std::round(8192 / std::max(crossing(wet, dry), smallest_distance)) / 8192;
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
