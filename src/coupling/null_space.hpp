#pragma once
#include "interfaces/fluid.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

/// Null spaces of the coupled operator and of its pressure block alone.
struct NullSpaces {
  NullSpace coupled;   ///< (n, V_S = 0) is in the kernel of Eq. 16
  NullSpace pressure;  ///< kernel of A: the regions without a Dirichlet face
};

/// The kernel over the regions R without a Dirichlet face: all c with sum_R c_R B^T chi_R = 0, from
/// the (solid dofs x regions) matrix B^T chi. Each group of regions that solids tie to one another
/// has a triangle R of its own, brought together over a tree of ranks; its kernel comes from an
/// SVD, or in large groups from a QR factorisation with pivoting. `coupling_transposed` may be null
/// (no dynamic solids): then both spaces are the same. Throws SolveError for more than 5000 regions
/// in a group. Collective.
NullSpaces find_null_spaces(const PressureRegions& regions, const RCP<const Map>& pressure_map,
                            const RCP<const CrsMatrix>& coupling_transposed);

/// B^T n for each null vector n of the pressure block, in one pass over B^T. Collective.
std::vector<RCP<const Vector>> pushes_of(const NullSpace& pressure,
                                         const CrsMatrix& coupling_transposed);

}  // namespace lockstep
