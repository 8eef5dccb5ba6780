#pragma once
#include <array>
#include <memory>
#include <vector>

#include "interfaces/strategy.hpp"
#include "linear/conjugate_gradients.hpp"
#include "multigrid/lattice_layout.hpp"
#include "multigrid/multigrid.hpp"

namespace lockstep {

/// The pressure unknowns in the multigrid's own order: flat, split by colour, with zeros where
/// there is no unknown. Krylov vectors live there during a solve, so that nothing is reordered
/// between A and its inverse.
class PressureLayout {
 public:
  virtual ~PressureLayout() = default;
  /// For the stencil of a system, which must have one (see `why_not`); `previous`, if any, gives
  /// its arrays and whatever else depends on the grid only. Collective.
  static std::shared_ptr<PressureLayout> make(const BlockSystem& system,
                                              const MultigridOptions& options,
                                              std::shared_ptr<PressureLayout> previous);
  /// Returns the reason why there can be no layout for this system, as a sentence; empty if there
  /// can.
  static std::string why_not(const BlockSystem& system);

  /// The system with its pressures in this layout; other things shared. Collective.
  BlockSystem permuted(const BlockSystem& system) const;
  /// Reorders; the layout's other entries are set to zero.
  void to_layout(const Vector& rows, Vector& layout) const;
  void from_layout(const Vector& layout, Vector& rows) const;

  const RCP<const Map>& map() const { return map_; }
  virtual RCP<const LinearOperator> pressure_block() const = 0;
  /// One cycle of the multigrid. A row that A leaves empty is divided by its entry in the diagonal
  /// of B diag(C)^-1 B^T.
  virtual RCP<const LinearOperator> inverse() const = 0;
  /// For another C on the same geometry: what divides the rows that A leaves empty. Returns whether
  /// there are any; the inverses and kernels are new ones then. Collective.
  virtual bool update_empty_rows(const BlockSystem& system) = 0;
  /// Conjugate gradients on A with that cycle.
  virtual ConjugateGradientKernels& kernels() = 0;

  /// Makes ready what follows, for the system in the fluid's own order; `solid_inverse` is C^-1,
  /// roughly. Once for a geometry, and anew for another C where it depends on C. Collective.
  virtual void build_schur_inverse(const BlockSystem& system,
                                   const LinearOperator& solid_inverse) = 0;
  virtual bool has_schur_inverse() const = 0;
  /// As an approximate inverse of A + B C^-1 B^T: one cycle for A and what gives way of soft solids
  /// (see schur_stencil.hpp); where there are none, that of A.
  virtual RCP<const LinearOperator> schur_inverse() const = 0;
  /// Products with A alone, and that cycle.
  virtual ConjugateGradientKernels& schur_kernels() = 0;

  virtual std::size_t bytes() const = 0;
  virtual MessageCount sent() const = 0;

 protected:
  std::shared_ptr<const LatticeLayout> layout_;
  RCP<const Map> map_;
  std::vector<int> entry_of_row_;
};

}  // namespace lockstep
