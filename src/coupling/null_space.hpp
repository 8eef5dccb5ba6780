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
/// an SVD of the (solid dofs x regions) matrix B^T chi, whose triangle is brought together over a
/// tree of ranks. `coupling_transposed` may be null (no dynamic solids): then both spaces are the
/// same. Collective.
NullSpaces find_null_spaces(const PressureRegions& regions, const RCP<const Map>& pressure_map,
                            const RCP<const CrsMatrix>& coupling_transposed);

}  // namespace lockstep
