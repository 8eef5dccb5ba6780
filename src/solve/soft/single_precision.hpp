#pragma once
#include "linear/near_null_space.hpp"

namespace lockstep {

/// A soft solid's C = M̃ - dt D rounded to single precision and stored in dense blocks, one for each
/// pair of nodes: a third of the memory that an application must read, for iterations that correct
/// their residual with C itself now and then. Symmetric if C is. Vectors and sums stay in double
/// precision. Null where nothing is to be had: without nodes, where rows or columns of a rank do
/// not fall into blocks, where blocks are half empty, and where D outweighs a node's mass by more
/// than 1e4, for rounding it would eat up what the mass does. Collective, and so is every
/// application.
RCP<const LinearOperator> single_precision_copy(const RCP<const CrsMatrix>& c,
                                                const NearNullSpace& space);

}  // namespace lockstep
