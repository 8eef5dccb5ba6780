#pragma once
#include <vector>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Marks the owned tiles of the narrow band: some cell within `reach` cells, ghosts included, has
/// |phi| below `cut_off` [m], or a surface of solids passes the tile that may part liquid from air,
/// or the tile has liquid at a side through which something flows. Elsewhere phi is +-cut_off and
/// no cell changes sides. Local; ghost values must be set.
template <int dim>
std::vector<char> tiles_near_band(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                                  const CellField& phi, double cut_off, int reach);

}  // namespace lockstep
