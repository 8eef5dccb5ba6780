#pragma once
#include <Thyra_VectorBase.hpp>

#include "interfaces/strategy.hpp"

namespace lockstep {

using ThyraVector = Thyra::VectorBase<double>;

/// Thyra view of a Tpetra vector: shares the values. `space` is the range or domain of the operator
/// it is used with.
RCP<ThyraVector> as_thyra(const RCP<Vector>& vector,
                          const RCP<const Thyra::VectorSpaceBase<double>>& space);

/// The vector (p̂, V_S) of a block operator, as a multivector of one column, which MueLu wants;
/// shares the values of both parts, which must be there.
RCP<Thyra::MultiVectorBase<double>> as_thyra(const BlockVector& vector, const LinearOperator& op);

}  // namespace lockstep
