#pragma once
#include <functional>
#include <string>

#include "linear/types.hpp"

namespace lockstep {

/// Replaces a right-hand side of n values by the solution. Called on rank 0 alone.
using SolveInPlace = std::function<void(double* values)>;
/// Factors a matrix whose rows all are on rank 0, where alone it is called. May throw any
/// std::exception.
using FactorOnRoot = std::function<SolveInPlace(const CrsMatrix& gathered)>;

/// The inverse of a square matrix, gathered and solved on rank 0. Row ids must be 0 .. n-1 in any
/// distribution. What `factor` throws becomes a SolveError on all ranks: `failure`, followed by its
/// words. Collective, and so is every application.
RCP<const LinearOperator> gathered_operator(const RCP<const CrsMatrix>& matrix,
                                            const FactorOnRoot& factor, const std::string& failure);

}  // namespace lockstep
