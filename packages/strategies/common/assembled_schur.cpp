#include "strategies/common/assembled_schur.hpp"

#include <TpetraExt_MatrixMatrix.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"
#include "linear/block_diagonal.hpp"

namespace lockstep {

namespace {

RCP<const CrsMatrix> need_assembled(const RCP<const LinearOperator>& op, const char* block,
                                    const BlockSystem& system) {
  const auto matrix = assembled(op);
  check_solve(
      !matrix.is_null(),
      "The {} of the {} is matrix-free, but its Schur complement is to be assembled. Choose "
      "the strategy schur-cg.",
      block, system.name);
  return matrix;
}

/// A + B K B^T.
RCP<const CrsMatrix> sum(const CrsMatrix& a, const CrsMatrix& coupling_transposed,
                         const CrsMatrix& k) {
  CrsMatrix k_bt(k.getRowMap(), 0);
  Tpetra::MatrixMatrix::Multiply(k, false, coupling_transposed, false, k_bt);
  CrsMatrix added(a.getRowMap(), 0);
  Tpetra::MatrixMatrix::Multiply(coupling_transposed, true, k_bt, false, added);
  return Tpetra::MatrixMatrix::add(1.0, false, a, 1.0, false, added, a.getDomainMap(),
                                   a.getRangeMap());
}

}  // namespace

RCP<const CrsMatrix> assembled_schur(const BlockSystem& system) {
  const auto a = need_assembled(system.pressure_block(), "pressure block", system);
  const auto c = need_assembled(system.solid_block(), "solid block", system);
  const auto blocks =
      block_diagonal_inverse(c, largest_dense_block, "solid block of the " + system.name);
  check_solve(
      blocks.exact,
      "The solid block of the {} does not fall apart into blocks of at most {} unknowns, so "
      "that its inverse, and with it the Schur complement, is dense. Choose the strategy "
      "schur-cg.",
      system.name, largest_dense_block);
  return sum(*a, *system.coupling_transposed(), *blocks.inverse);
}

RCP<const CrsMatrix> schur_with_diagonal(const BlockSystem& system) {
  const auto a = need_assembled(system.pressure_block(), "pressure block", system);
  const auto c = need_assembled(system.solid_block(), "solid block", system);
  return sum(*a, *system.coupling_transposed(),
             *jacobi_inverse(*c, "solid block of the " + system.name));
}

}  // namespace lockstep
