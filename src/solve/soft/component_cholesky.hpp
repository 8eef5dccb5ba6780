#pragma once
#include <string>
#include <vector>

#include "solve/soft/components.hpp"

namespace lockstep {

/// Inverse of a symmetric positive definite matrix on the components whose factors are cheap.
struct ComponentCholesky {
  RCP<const LinearOperator> inverse;  ///< the rows of other components become 0
  std::vector<bool> is_factored;      ///< by local row
};

/// Gathers the matrix on rank 0, orders each component by nested dissection (METIS), and factors it
/// there (Eigen) if that takes at most `most_operations` multiplications. A cloth's factors are
/// cheaper than those of a volume of as many nodes by orders of magnitude: hence no rule of rows or
/// entries, but the count. Row ids must be 0 .. n-1. Throws SolveError if a component is not
/// positive definite; `name` is for messages. Collective, and so is every application.
ComponentCholesky cheap_component_cholesky(const RCP<const CrsMatrix>& matrix,
                                           const std::vector<RowComponent>& components,
                                           double most_operations, const std::string& name);

}  // namespace lockstep
