#pragma once
#include <vector>

#include "multigrid/stencil_level.hpp"

namespace lockstep {

/// A cell of the fine level that corrects with another coarse cell than the one it lies in (see
/// thin_walls.hpp). Only cells of colour 0, the ones that transfer residuals and corrections.
struct MovedCell {
  int m = 0, j = 0, k = 0;  ///< its row and slot
  int colour_from = 0, colour_to = 0;
  std::ptrdiff_t from = 0;  ///< slot of the coarse cell that it lies in
  std::ptrdiff_t to = -1;   ///< slot of the one it goes to; -1: it corrects with none
};

/// Connection of a level to the next coarser one: cell (i, j, k) lies in the coarse cell (i >> 1, j
/// >> 1, k >> 1) + offset, local coordinates. Piecewise constant: restriction sums over the cells
/// of a coarse cell, prolongation copies, each the transpose of the other.
struct Transfer {
  std::array<int, 3> offset{};
  std::vector<MovedCell> moved;      ///< sorted by slab
  std::vector<std::size_t> in_slab;  ///< by slab: the first of `moved`; one more at the end
  bool leaves_rank = false;          ///< some rank moves a cell to a ghost
};

struct CoarseningFactors {
  float unit = 1;       ///< coupling through a regular face of the fine level
  float dirichlet = 1;  ///< factor of the sum of fine Dirichlet parts [1]
};

/// The coarse stencil: a coarse face is the sum of its fine faces, each in series with half a
/// regular one on either side (half of it, if it is regular itself: its area over twice the
/// distance); a Dirichlet part is the sum of the fine ones times `factors.dirichlet`, a reaction
/// the sum. Cells behind thin walls are moved first. Everything of `coarse` is overwritten.
/// Collective.
Transfer coarsen(const LayoutLevel& fine_level, const NaturalStencil& fine,
                 const LayoutLevel& coarse_level, const LatticeBlocks& blocks,
                 const CoarseningFactors& factors, NaturalStencil& coarse);

}  // namespace lockstep
