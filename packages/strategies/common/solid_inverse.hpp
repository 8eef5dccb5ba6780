#pragma once
#include <memory>
#include <optional>

#include "interfaces/strategy.hpp"
#include "linear/inverse_by_cost.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Declares "Solid Inverse", the list that names the approximate inverse of C. Its "Type" is
///   "Automatic"  the default. Exact for the bodies where that is cheap (see
///                inverse_by_cost.hpp); else chosen by stiffness_number. Inner iterations, run on a
///                rounded C where that is safe (single_precision.hpp), take the diagonal of C while
///                M̃ dominates, "Additive Multilevel" where dt D does, and MueLu with the rigid
///                motions of the bodies beyond; approximations of C^-1 take MueLu earlier
///   "Exact"      that to round-off, by conjugate gradients where it must iterate
/// or one of linear/preconditioner.hpp.
void declare_solid_inverse(ParameterList& list);

/// C^-1 and what stands for it in preconditioners.
class SolidInverse {
 public:
  /// Of no solid.
  SolidInverse() = default;
  /// `list` has "Solid Inverse" or leaves it out. Throws InputError for a bad sublist.
  explicit SolidInverse(const ParameterList& list);

  /// Builds all that follows from C. Throws SolveError if C does not allow it. Collective.
  void build(const BlockSystem& system);
  void reset();
  bool is_built() const { return !exact_.is_null(); }
  /// Whether C^-1 is an iteration, whose cost depends on what it is asked for.
  bool iterates() const { return iterates_; }

  /// C^-1 to round-off. Null before `build`.
  const RCP<const LinearOperator>& exact() const { return exact_; }
  /// C^-1 to this relative residual, where it must iterate; else to round-off.
  RCP<const LinearOperator> to(double tolerance) const;
  /// What the list names: symmetric positive definite and, unless it iterates itself, linear.
  /// Built when first asked for, which is collective then.
  const RCP<const LinearOperator>& approximate() const;
  /// "Automatic" and nothing more.
  bool is_automatic() const { return type_ == "Automatic"; }
  /// Inner iterations since the last call.
  int take_iterations();

 private:
  void build_automatic(const BlockSystem& system);
  void build_named(const BlockSystem& system);

  ParameterList list_;
  std::string type_ = "Automatic";
  RCP<const LinearOperator> exact_;
  mutable RCP<const LinearOperator> approximate_;
  std::optional<InverseByCost> split_;  ///< of "Automatic" and "Exact"
  bool iterates_ = false;
  RCP<const LinearOperator> iterated_;        ///< C, or what of it is not cheap
  RCP<const LinearOperator> preconditioner_;  ///< of that; null: none
  RCP<const LinearOperator> rounded_;         ///< C in single precision; null: not had
  std::string preconditioner_type_;           ///< of "Automatic" where it iterates
  NearNullSpace motions_;                     ///< of what is iterated on
  std::string name_;
  std::shared_ptr<long> iterations_ = std::make_shared<long>(0);
};

}  // namespace lockstep
