#pragma once
#include <Thyra_VectorBase.hpp>
#include <vector>

#include "interfaces/strategy.hpp"

namespace lockstep {

using ThyraVector = Thyra::VectorBase<double>;

/// Thyra view of a Tpetra vector: shares the values. `space` is the range or domain of the operator
/// it is used with.
RCP<ThyraVector> as_thyra(const RCP<Vector>& vector,
                          const RCP<const Thyra::VectorSpaceBase<double>>& space);

/// Product vector (p̂, V_S) of a block operator; shares the values of both parts.
RCP<ThyraVector> as_thyra(const BlockVector& vector, const LinearOperator& block_operator);

/// The Tpetra vectors behind the first column of a (product) multivector; shares the values.
std::vector<RCP<Vector>> blocks_of(const RCP<Thyra::MultiVectorBase<double>>& vectors);

/// Eq. 16 as a blocked operator [A, -B; -B^T, -C], nothing copied. With `pressure_scale` s and
/// `solid_scale` t, the symmetrically scaled [s^2 A, -s t B; -s t B^T, -t^2 C], for unknowns p̂/s
/// and V_S/t. The system must have a solid block. Collective.
RCP<const LinearOperator> block_operator(const BlockSystem& system, double pressure_scale = 1,
                                         double solid_scale = 1);

/// Right-hand side of row 1 and row 2 of Eq. 16: (pressure rhs, -solid rhs). Copies.
BlockVector signed_rhs(const BlockVector& rhs);

/// Throws SolveError unless every rank owns a row of both blocks: Belos' inner products of Thyra
/// vectors are wrong otherwise. `who` names the solver. Collective.
void check_no_empty_rank(const BlockSystem& system, const std::string& who);

}  // namespace lockstep
