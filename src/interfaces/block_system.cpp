#include "interfaces/block_system.hpp"

#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"

namespace lockstep {

void BlockSystem::set_blocks(const RCP<const LinearOperator>& pressure_block,
                             const RCP<const CrsMatrix>& coupling_transposed,
                             const RCP<const LinearOperator>& solid_block) {
  LOCKSTEP_ASSERT(!pressure_block.is_null());
  LOCKSTEP_ASSERT(coupling_transposed.is_null() == solid_block.is_null());
  pressure_block_ = pressure_block;
  coupling_transposed_ = coupling_transposed;
  solid_block_ = solid_block;
  const int n_groups = has_solid() ? 2 : 1;
  const auto op = Thyra::defaultBlockedLinearOp<double>();
  op->beginBlockFill(n_groups, n_groups);
  op->setBlock(0, 0, pressure_block);
  if (has_solid()) {
    const RCP<const LinearOperator> transposed = as_operator(coupling_transposed);
    op->setBlock(0, 1, Thyra::scale<double>(-1, Thyra::adjoint<double>(transposed)));
    op->setBlock(1, 0, Thyra::scale<double>(-1, transposed));
    op->setBlock(1, 1, Thyra::scale<double>(-1, solid_block));
  }
  op->endBlockFill();
  op->setObjectLabel(name);
  op_ = op;
}

}  // namespace lockstep
