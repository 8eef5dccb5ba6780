#pragma once
#include <memory>

#include "strategies/common/belos_method.hpp"
#include "strategies/common/refined_strategy.hpp"
#include "strategies/stratimikos/block_inverses.hpp"
#include "strategies/stratimikos/solver_facts.hpp"

namespace lockstep {

/// Eq. 16 as a Thyra operator of blocks, solved by a Belos solver with a Teko preconditioner, both
/// as a Stratimikos list says: the strategy of all methods that a list can name. The list's keys
/// stand beside those that all strategies share; `register_inverse_types` tells which inverses Teko
/// knows besides its own.
///
/// The strategy solves by Belos again for what one solve leaves, until each block's residual is
/// below the tolerance: so a method may stop where single precision in the multigrid, or its own
/// recurrence, lets it go no further. "Convergence Tolerance" in the list is what one of them aims
/// at, at most. Systems without solids take conjugate gradients with the list's inverse of A, which
/// must be symmetric positive definite.
class StratimikosStrategy : public RefinedStrategy, private BlockInverses {
 public:
  explicit StratimikosStrategy(const ParameterList& list);
  ~StratimikosStrategy() override;
  static ParameterList valid_parameters();
  std::string name() const override { return "stratimikos"; }
  std::string inverses() const override;

 private:
  /// `complete` has all parameters.
  StratimikosStrategy(const ParameterList& complete, const SolverFacts& facts);
  /// The parts of Trilinos that the list makes, out of sight of other files.
  struct Trilinos;

  void build(const BlockSystem& system, bool geometry_changed, bool solid_changed) override;
  bool is_built_for(const BlockSystem& system) const override;
  bool inverts_schur() const override { return facts_.wants_schur; }
  int correct(const BlockSystem& system, const CorrectionRequest& request,
              Vector& correction) override;

  const BlockSystem& system() const override { return *system_; }
  bool is_pressure_block(const RCP<const LinearOperator>& op) const override;
  bool is_solid_block(const RCP<const LinearOperator>& op) const override;
  RCP<const LinearOperator> multigrid() const override { return pressure_inverse(); }
  RCP<const LinearOperator> schur_multigrid() const override;
  const SolidInverse& solid() const override { return RefinedStrategy::solid(); }

  /// The operator that Teko gets: that of the system, or one with what a factorisation of its
  /// blocks needs, a regular A and explicit matrices. Collective.
  RCP<const BlockedOperator> operator_for_set_up(const BlockSystem& system) const;
  /// An inverse of the library for an operator; what fails is told in our words. Collective.
  RCP<const LinearOperator> inverse_of(const RCP<const LinearOperator>& op,
                                       const std::string& name);

  SolverFacts facts_;
  BelosMethod method_;
  std::unique_ptr<Trilinos> trilinos_;
  const BlockSystem* system_ = nullptr;       ///< while something is built
  RCP<const BlockedOperator> set_up_;         ///< lives as long as what Teko made for it
  RCP<const LinearOperator> preconditioner_;  ///< preconditioner of the whole; null without one
  RCP<const LinearOperator> fluid_inverse_;   ///< inverse of A alone
  std::unique_ptr<FlatSystem> flat_;          ///< null: not built for solids
};

}  // namespace lockstep
