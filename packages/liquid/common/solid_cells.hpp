#pragma once
#include <algorithm>
#include <memory>
#include <vector>

#include "staggered/domain/mac_domain.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

struct CellGroups;

/// The solids at one instant, as cell centres see them.
template <int dim>
struct SolidCells {
  /// Cells are `fluid` (liquid or not), `solid` or `outside`; faces `free` beside a fluid cell,
  /// else `inactive`.
  GridState<dim> state;
  /// Bit a: a surface comes between the centres on both sides of the lower face normal to axis a.
  /// Empty without a surface.
  std::vector<char> occluded;
  std::vector<char> near;  ///< a surface comes within h/2 of the cell; empty without a surface
  mutable std::shared_ptr<const CellGroups> closed_spaces;  ///< once somebody has looked for them

  /// True if any of the solids encloses a volume (`closed`), or is a thin shell.
  bool has_solids(bool closed) const {
    const auto is_one = [=](const SolidDescription& solid) { return solid.closed == closed; };
    return state.surface &&
           std::any_of(state.surface->solids().begin(), state.surface->solids().end(), is_one);
  }
  bool has_shells() const { return has_solids(false); }
  bool near_surface(int cell) const { return !near.empty() && near[cell] != 0; }
  bool is_fluid(int cell) const { return state.cells[cell] == CellState::fluid; }
  /// Returns the fluid cell beside a fluid cell if no surface comes between their centres, else -1.
  int seen_neighbor(const TiledGrid<dim>& grid, int cell, int axis, int side) const {
    const int other = grid.neighbor(cell, axis, side);
    if (other < 0 || !is_fluid(other))
      return -1;
    const int face = side == 0 ? cell : other;
    return !occluded.empty() && (occluded[face] >> axis & 1) ? -1 : other;
  }
};

/// `surface` may be null or empty. Local.
template <int dim>
SolidCells<dim> find_solid_cells(const MacDomain<dim>& domain,
                                 const std::shared_ptr<const SurfaceSnapshot<dim>>& surface);

}  // namespace lockstep
