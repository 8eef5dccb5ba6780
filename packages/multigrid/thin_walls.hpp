#pragma once
#include <vector>

#include "multigrid/lattice_layout.hpp"
#include "multigrid/stencil_level.hpp"

namespace lockstep {

/// Coarse neighbour that a fine cell belongs to instead of the coarse cell it lies in.
namespace destination {
constexpr char own = 0;
/// 1 + 2 axis + side: the neighbour there.
inline char neighbor(int axis, int side) {
  return static_cast<char>(1 + 2 * axis + side);
}
constexpr char none = 7;
/// The steps to it, in coarse cells.
std::array<int, 3> step(char destination);
}  // namespace destination

/// A thin wall may run through a coarse cell and cut its fine cells into parts that do not see each
/// other; correcting them alike would leak through the wall. The largest part keeps the coarse
/// cell. Every other part is given to the neighbouring coarse cell that most of its open faces lead
/// to (where the cell they touch keeps its own), or to none.
///
/// Returns a natural array of destinations, ghosts included, or an empty one if no cell of any rank
/// moves. Ties go to the part with the lowest child, the lowest axis, the lower side, so that a
/// plane of parts moves as one and the result does not depend on the ranks. Collective.
std::vector<char> destinations_behind_thin_walls(const LayoutLevel& level,
                                                 const NaturalStencil& stencil,
                                                 const Communicator& comm);

}  // namespace lockstep
