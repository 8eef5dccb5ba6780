#pragma once
#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "interfaces/strategy.hpp"
#include "multigrid/pressure_layout.hpp"
#include "solve/block_residual.hpp"
#include "strategies/common/belos_method.hpp"
#include "strategies/common/solid_inverse.hpp"

namespace lockstep {

/// The common part of all strategies: the caching of what depends on the operators, and a loop of
/// iterative refinement that judges convergence by the true residual of each block.
///
/// V_S is always back-substituted from row 2, V_S = C^-1 (solid rhs - B^T p̂), so that momentum is
/// exact; what is left of an error sits in row 1, the divergence, and a correction solves Eq. 16
/// with right-hand side (r_1, 0). The initial guess of V_S is therefore ignored.
///
/// A strategy that names an approximate inverse of A gets it from here. Where that is the
/// multigrid, the whole solve takes place in the multigrid's layout: `build` and `correct` are then
/// given the system with its pressures reordered, and never notice.
class RefinedStrategy : public SolverStrategy {
 public:
  /// Reuses what was built last for a system of the same name, versions and maps. What belongs to A
  /// alone serves the system with and without its solid block (S1, F2 and S2 of one geometry).
  /// Collective.
  void prepare(const BlockSystem& system) final;
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) final;
  std::string inverses() const override;

 protected:
  /// Reads the parameters common to all strategies, which must all be there. `pressure_list` names
  /// the approximate inverse of A, for strategies that use one (see pressure_inverse.hpp). A
  /// strategy that needs A as a matrix asks for the fluid's own order of pressures; the multigrid
  /// then reorders at every application.
  enum class PressureOrder { of_the_inverse, of_the_fluid };
  explicit RefinedStrategy(const Teuchos::ParameterList& list,
                           std::optional<Teuchos::ParameterList> pressure_list = {},
                           PressureOrder order = PressureOrder::of_the_inverse);

  struct CorrectionRequest {
    std::string name;        ///< for messages
    Vector* residual;        ///< r_1, free of null vectors; may be overwritten
    double residual_norm;    ///< |r_1|
    double target;           ///< target of |r_1|
    double solid_round_off;  ///< round-off below which |r_2| cannot fall
    int maximum_iterations;
    /// `target` for the solution that this correction would give: the scales move with it.
    std::function<double(const Vector& correction)> update_target;
  };

  /// Builds what depends on the operators, beside the inverses of A and C. `geometry_changed` and
  /// `solid_changed` say what is new. Default: nothing.
  virtual void build(const BlockSystem&, bool /*geometry_changed*/, bool /*solid_changed*/) {}
  /// True if nothing is missing for this system (with or without solid) at unchanged operators.
  virtual bool is_built_for(const BlockSystem&) const { return true; }
  /// True if the strategy uses the layout's approximate inverse of A + B C^-1 B^T.
  virtual bool inverts_schur() const { return false; }
  /// True if `correct` iterates on C so often that it should aim at a part of the reduction only,
  /// and be called again.
  virtual bool works_in_stages() const { return false; }
  /// Entries of the matrices that the strategy has assembled for itself; 0 if it does not count.
  virtual long stored_nonzeros() const { return 0; }
  /// An approximate solution p̂ of Eq. 16 with right-hand side (r_1, 0), written to `correction`;
  /// returns the number of iterations. The same without a solid block: A p̂ = r_1.
  virtual int correct(const BlockSystem& system, const CorrectionRequest& request,
                      Vector& correction) = 0;

  /// The approximate inverse of A that the list names, symmetric positive definite.
  const RCP<const LinearOperator>& pressure_inverse() const { return pressure_inverse_; }
  /// The layout that `build` and `correct` work in, which holds A and this inverse as kernels; null
  /// if the inverse is another.
  PressureLayout* layout() const { return layout_.get(); }
  /// Relative asymmetry that the inverse may have: round-off of the precision it works in.
  double symmetry_tolerance() const { return is_single_precision_ ? 1e-5 : 1e-8; }
  /// The null vectors that an iteration must project out of every preconditioned residual; none
  /// where the inverse of A leaves them harmless.
  const NullSpace& iteration_null_space(const BlockSystem& system) const;
  /// A correction for a system without solid: conjugate gradients on A with that inverse.
  int pressure_cg(const BlockSystem& system, const CorrectionRequest& request,
                  Vector& correction) const;
  /// C^-1 to round-off; null without a solid block.
  const RCP<const LinearOperator>& solid_inverse() const { return solid_.exact(); }
  /// C^-1 to round-off and the inverse that "Solid Inverse" names to stand for it.
  const SolidInverse& solid() const { return solid_; }
  bool check_symmetry() const { return check_symmetry_; }
  /// Makes the request of a Krylov method on both blocks from that of a correction. One that
  /// presumes a linear, symmetric inverse of A asks for no more than what single precision allows
  /// before a fresh start.
  enum class Presumes { nothing, symmetry };
  BlockKrylovRequest block_krylov(const BlockSystem& system, const CorrectionRequest& request,
                                  Presumes presumes);

 private:
  struct Prepared {
    std::string system_name;
    long geometry_version = 0, solid_version = 0;
    RCP<const Map> pressure_map, solid_map;
  };

  /// The system as `build` and `correct` see it.
  const BlockSystem& working(const BlockSystem& system) const {
    return layout_ ? (system.has_solid() ? permuted_ : permuted_pressure_) : system;
  }
  void build_pressure_inverse(const BlockSystem& system);
  /// Updates the inverse for another C on the same geometry; returns true if it is another now.
  bool update_pressure_inverse(const BlockSystem& system);
  void relay(const BlockSystem& system);
  SolveReport refine(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                     const SolveRequest& request);
  bool is_ready(const BlockSystem& system) const;
  bool geometry_matches(const BlockSystem& system) const;
  bool solid_matches(const BlockSystem& system) const;

  int maximum_iterations_;
  bool check_symmetry_;
  PressureOrder order_;
  bool is_single_precision_ = false;
  bool is_prepared_ = false;
  Prepared prepared_;
  SolidInverse solid_;
  double solid_norm_ = -1;  ///< |B C^-1|; negative: not known yet
  std::optional<Teuchos::ParameterList> pressure_list_;
  RCP<const LinearOperator> pressure_inverse_;
  std::shared_ptr<PressureLayout> layout_;  ///< null: pressures stay in the fluid's order
  BlockSystem permuted_, permuted_pressure_;
  double setup_seconds_ = 0;
  int n_builds_ = 0, n_reuses_ = 0;
};

}  // namespace lockstep
