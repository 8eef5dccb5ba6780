#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// A matrix of a sum: its row and column ids, moved by `shift`, are those of the sum.
struct Summand {
  RCP<const CrsMatrix> matrix;
  GlobalIndex shift = 0;
  double factor = 1;
};

/// sum_k factor_k matrix_k on the rows and columns of `map`, where every row of a summand belongs
/// to the same rank as in the sum; so no entry moves between ranks, and it takes one pass over
/// them. `unit_rows` (local numbers) get a 1 on the diagonal beside. Values of one place are added
/// in the order of the summands. Collective.
RCP<CrsMatrix> sum_of(const std::vector<Summand>& summands, const RCP<const Map>& map,
                      const std::vector<int>& unit_rows = {});

}  // namespace lockstep
