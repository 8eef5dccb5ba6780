#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Nodes of this rank: rows that follow one another, one for each axis.
struct RowsOfNodes {
  int n_axes = 0;
  std::vector<int> first;   ///< local row, by node
  std::vector<int> of_row;  ///< node by local row; -1: of none
};

/// Aggregates of this rank's nodes, as in smoothed aggregation (Vanek, Mandel and Brezina 1996):
/// nodes whose neighbours in the matrix are all free begin one with them; the others join one
/// beside them, or stay alone.
struct Aggregates {
  int n = 0;
  std::vector<int> of_node;
};
Aggregates aggregate(const CrsMatrix& matrix, const RowsOfNodes& nodes);

/// Q^T A Q for the translations Q of aggregates: `place_of_row` is the local row of the result for
/// every local row of A, -1 for none; `map` is that of the result. Collective.
RCP<CrsMatrix> coarse_matrix(const CrsMatrix& matrix, const std::vector<int>& place_of_row,
                             const RCP<const Map>& map);

}  // namespace lockstep
