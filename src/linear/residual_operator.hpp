#pragma once
#include <Tpetra_Operator.hpp>

#include "linear/types.hpp"

namespace lockstep {

/// An operator that finds in one pass over memory what an equation with it still lacks.
class ResidualOperator : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  /// 2-norms over all ranks.
  struct Norms {
    double rhs = 0, product = 0, residual = 0;
  };
  /// r = rhs - (operator) x; r may be any vector of this operator's range. Collective.
  virtual Norms residual(const Vector& rhs, const Vector& x, Vector& r) const = 0;
};

/// The one behind a Thyra operator, or null.
const ResidualOperator* residual_operator_of(const RCP<const LinearOperator>& op);

}  // namespace lockstep
