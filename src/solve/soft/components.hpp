#pragma once
#include <vector>

#include "linear/near_null_space.hpp"

namespace lockstep {

/// A connected component of the nonzeros of a matrix, as a row of it sees it.
struct RowComponent {
  GlobalIndex id = 0;      ///< the lowest row of the component
  GlobalIndex n_rows = 0;  ///< on all ranks
};

/// The components of a matrix of symmetric pattern that stores its diagonal, by local row, wherever
/// their rows live. The rows of a node of `space` count as connected: in a flat cloth nothing else
/// ties what moves in its plane to what moves out of it. Collective.
std::vector<RowComponent> components_of_rows(const CrsMatrix& matrix,
                                             const NearNullSpace& space = {});

}  // namespace lockstep
