#pragma once
#include "linear/types.hpp"

namespace lockstep {

/// The matrix rounded to single precision and stored in dense blocks of `block` x `block` entries
/// (the dofs of a node): a third of the memory that an application must read, for iterations that
/// correct their residual with the matrix itself now and then. Symmetric if the matrix is. Vectors
/// and sums stay in double precision. Null where nothing is to be had: where rows or columns of a
/// rank do not fall into blocks, where blocks are half empty, or where an entry is too large.
/// Collective, and so is every application.
RCP<const LinearOperator> single_precision_copy(const RCP<const CrsMatrix>& matrix, int block);

}  // namespace lockstep
