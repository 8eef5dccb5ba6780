#pragma once
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// One contribution to a matrix entry, on any rank.
struct Triplet {
  GlobalIndex row;
  GlobalIndex column;
  double value;
};

/// Sums the triplets of all ranks into a matrix with the given one-to-one row map (also its range)
/// and domain map, by a RowBuilder. Contributions to rows of other ranks are sent there in one
/// exchange. Collective.
RCP<CrsMatrix> assemble_triplets(std::vector<Triplet> triplets, const RCP<const Map>& row_map,
                                 const RCP<const Map>& domain_map);

}  // namespace lockstep
