#pragma once
#include "linear/stencil_operator.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// The owned tiles of a grid as blocks of cells, in the order of the cell ids, in the smallest box
/// that holds all tiles.
template <int dim>
std::shared_ptr<const LatticeBlocks> lattice_blocks(const TiledGrid<dim>& grid);

/// A = V G_f^T rho^-1 G_f over the open part of free faces: 2 dim + 1 points, never a matrix unless
/// asked for. A cell without free face has an empty row. `domain` must outlive it. Collective.
template <int dim>
RCP<const StencilOperator> pressure_operator(const MacDomain<dim>& domain,
                                             const MacGeometry<dim>& geometry,
                                             std::shared_ptr<const LatticeBlocks> blocks);

}  // namespace lockstep
