#pragma once
#include <memory>
#include <optional>

#include "interfaces/strategy.hpp"
#include "parameters/parameter_list.hpp"
#include "solve/soft/inverse_by_cost.hpp"

namespace lockstep {

/// Declares "Solid Inverse", the list that names the approximate inverse of C. Its "Type" is
///   "Automatic"  the default. Exact for the bodies where that is cheap (see
///                inverse_by_cost.hpp); else chosen by stiffness_number. Inner iterations, run on a
///                rounded C where that is safe (single_precision.hpp), take the diagonal of C while
///                M̃ dominates, "Additive Multilevel" where dt D does, and MueLu with the rigid
///                motions of the bodies beyond; approximations of C^-1 take MueLu earlier
///   "Exact"      that to round-off, by conjugate gradients where it must iterate
/// or one of solve/preconditioner.hpp.
void declare_solid_inverse(ParameterList& list);

/// C^-1 and its approximation in preconditioners.
class SolidInverse {
 public:
  /// Makes the inverse of a system without solid.
  SolidInverse() = default;
  /// `list` has "Solid Inverse" or leaves it out. Throws InputError for a bad sublist.
  explicit SolidInverse(const ParameterList& list);

  /// Builds all that follows from C. Throws SolveError if C does not allow it. Collective.
  void build(const BlockSystem& system);
  void reset();
  bool is_built() const { return !exact_.is_null(); }
  /// True if C^-1 is an iteration, whose cost depends on the tolerance.
  bool iterates() const { return !iterated_.empty(); }

  /// C^-1 to round-off. Null before `build`.
  const RCP<const LinearOperator>& exact() const { return exact_; }
  /// C^-1 to this relative residual, where it must iterate; else to round-off.
  RCP<const LinearOperator> to(double tolerance) const;
  /// Returns the inverse that the list names: symmetric positive definite and, unless it iterates
  /// itself, linear. Built when first asked for, which is collective then.
  const RCP<const LinearOperator>& approximate() const;
  /// Returns what has been built, for tables: "exact", "conjugate gradients with Jacobi", or where
  /// `approximate` was asked for its types, "MueLu".
  std::string description() const;
  /// "Automatic" and nothing more.
  bool is_automatic() const { return type_ == "Automatic"; }
  /// Inner iterations since the last call.
  int take_iterations();
  /// Counts on from this number.
  void restart_count(int iterations) { *iterations_ = iterations; }

 private:
  /// C, or a part of it that is not cheap.
  struct Iterated {
    RCP<const LinearOperator> op;
    RCP<const LinearOperator> preconditioner;  ///< preconditioner of `op`; null: none
    RCP<const LinearOperator> rounded;         ///< it in single precision; null: not had
    std::string preconditioner_type;           ///< type that "Automatic" has chosen
    NearNullSpace motions;
    double stiffness = 1;
  };

  RCP<const LinearOperator> approximation(const Iterated& iterated,
                                          const InverseByCost::Rest& rest) const;
  void build_automatic(const BlockSystem& system);
  void build_named(const BlockSystem& system);
  Iterated prepared(const InverseByCost::Rest& rest) const;
  RCP<const LinearOperator> iteration(const Iterated& iterated, double tolerance) const;

  ParameterList list_;
  std::string type_ = "Automatic";
  RCP<const LinearOperator> exact_;
  mutable RCP<const LinearOperator> approximate_;
  mutable std::set<std::string> approximate_types_;  ///< types that `approximation` has chosen
  std::optional<InverseByCost> split_;               ///< split by "Automatic" and "Exact"
  InverseByCost::Costly costly_;
  std::vector<Iterated>
      iterated_;  ///< parts that "Automatic" and "Exact" iterate on, in the order of their rests
  std::string name_;
  std::shared_ptr<long> iterations_ = std::make_shared<long>(0);
};

}  // namespace lockstep
