#pragma once
#include <Teuchos_ParameterList.hpp>
#include <string>

#include "linear/near_null_space.hpp"

namespace lockstep {

/// An approximate inverse of C = M̃ - dt D of soft solids whose quality depends neither on the
/// stiffness nor on the mesh: on the nodes' rows MueLu with the rigid motions as near null space,
/// plus R_b (R_b^T C R_b)^-1 R_b^T for the motions R_b of each body, for the smaller M̃ is beside
/// dt D, the less MueLu's own coarse solver sees of them; on the others dense blocks. `list` goes
/// to MueLu. Symmetric positive definite for symmetric smoothers. Throws SolveError if MueLu fails.
/// Collective.
RCP<const LinearOperator> rigid_motion_multigrid(const RCP<const CrsMatrix>& c,
                                                 const NearNullSpace& space,
                                                 const Teuchos::ParameterList& list,
                                                 const std::string& name);

}  // namespace lockstep
