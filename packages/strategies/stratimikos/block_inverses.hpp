#pragma once
#include <exception>

#include "interfaces/strategy.hpp"
#include "strategies/common/solid_inverse.hpp"

namespace lockstep {

/// The strategy as seen by the inverses of its Teko library (`register_inverse_types`). A library
/// is handed operators one by one; an inverse of A wants the lattice that A lives on, one of A + B
/// C^-1 B^T the whole of Eq. 16.
class BlockInverses {
 public:
  virtual ~BlockInverses() = default;
  /// Eq. 16 in the order of the strategy's vectors.
  virtual const BlockSystem& system() const = 0;
  /// True if this is the block of A, or a multiple of that of -C, that the library was given.
  virtual bool is_pressure_block(const RCP<const LinearOperator>& op) const = 0;
  virtual bool is_solid_block(const RCP<const LinearOperator>& op) const = 0;
  /// A cycle of the multigrid for A.
  virtual RCP<const LinearOperator> multigrid() const = 0;
  /// A cycle for A and what gives way of soft solids (`PressureLayout::schur_inverse`), or
  /// smoothed aggregation for A + B diag(C)^-1 B^T; null if the list names no multigrid.
  virtual RCP<const LinearOperator> schur_multigrid() const = 0;
  virtual const SolidInverse& solid() const = 0;

  /// Teko catches what our inverses throw and throws a copy without its message: they leave it
  /// here.
  std::exception_ptr failure;
};

/// The name under which Teko's request handler knows a `BlockInverses*`.
inline constexpr const char* block_inverses_request = "Lockstep block inverses";

/// Registers with Teko, once:
///   "Lockstep Multigrid"   of A: a cycle of the matrix-free multigrid ("Sweeps", 2; "Cycle", "V");
///                          smoothed aggregation where A is no stencil on a lattice
///   "Lockstep Solid"       of C as the strategy's "Solid Inverse" says, to round-off with "Exact"
///                          (false), or by a list "Inverse" of its own; of assembled Schur
///                          complements of the solids to round-off, or by that list
///   "Lockstep Schur"       of A + B C^-1 B^T ("Inverse Type": of A; up to "Largest Solid", 18,
///                          unknowns that are so light that the fluid adds "Least Added Mass",
///                          1000, times their mass, by Woodbury's formula)
///   "Incomplete Cholesky"  without fill, of an assembled block
/// Blocks with a negative sign, as -C of Eq. 16, get a negative inverse.
void register_inverse_types();

}  // namespace lockstep
