#pragma once
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Marks of a surface on the grid, on all stored cells.
template <int dim>
struct SurfaceMarks {
  /// Bit a: the segment between the two pressure points of the lower face normal to axis a meets
  /// the surface.
  std::vector<char> occluded;
  std::vector<char> near;  ///< the surface comes within h/2 of the cell (maximum norm)
};

/// Lattice coordinates [begin, end) of a box of cells of the domain that holds the stored tiles.
template <int dim>
std::array<Index<dim>, 2> stored_range(const TiledGrid<dim>& grid);

/// Sets cells whose centre is inside a closed solid to `CellState::solid` and marks occluded faces,
/// all from the crossings of the cell-centre lines, so that both agree. Not collective.
template <int dim>
SurfaceMarks<dim> mark_surface(const MacDomain<dim>& domain, const SurfaceSnapshot<dim>& surface,
                               std::vector<CellState>& cells);

}  // namespace lockstep
