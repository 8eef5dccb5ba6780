#pragma once
#include <vector>

#include "interfaces/fluid.hpp"

namespace lockstep {

/// Null spaces of the coupled operator and of its pressure block alone, as orthonormal pressure
/// vectors.
struct NullSpace {
  std::vector<RCP<const Vector>> coupled;   ///< (n, V_S = 0) is in the kernel of Eq. 16
  std::vector<RCP<const Vector>> pressure;  ///< kernel of A: the regions without a Dirichlet face
};

/// The kernel over the regions R without a Dirichlet face: all c with sum_R c_R B^T chi_R = 0, from
/// an SVD of the (solid dofs x regions) matrix B^T chi. `coupling_transposed` may be null (no
/// dynamic solids): then both spaces are the same. Collective.
NullSpace find_null_space(const PressureRegions& regions, const RCP<const Map>& pressure_map,
                          const RCP<const CrsMatrix>& coupling_transposed);

}  // namespace lockstep
