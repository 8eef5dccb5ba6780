#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/constraint.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// Divides the dofs of the solids into unknowns y and dofs with given or dependent velocities: V =
/// P y + b (in the manner of deal.II's AffineConstraints). A dof is an *unknown*, whose row of P is
/// that of the identity; or *given*: its row of P is zero, its velocity stands in b; or a
/// *combination* of others. Locks, pins, scripts, and nodes carried by rigid solids are such
/// constraints.
///
/// Velocities V, momenta q, masses and forces outside of a solve are those of all dofs; a solve
/// sees C_y = P^T C P, P^T B^T and P^T (q - C b), and V = P y + b is its answer. Reduced vectors
/// live on the map of all dofs and are zero on those that are no unknowns, reduced matrices have
/// rows of the identity there. Forces that meet P^T q = 0 do no work, and if the combinations are
/// rigid motions they have neither a sum nor a torque.
///
/// Every rank holds the rows of its own dofs; what they need of other ranks' comes by an Import.
/// Without constraints nothing is stored and nothing is done. Cheap to copy.
class Reduction {
 public:
  /// Names a dof in messages.
  using NameOf = std::function<std::string(GlobalIndex)>;

  Reduction() = default;
  /// `combinations` and `given` (ids): of dofs that this rank owns. Combinations of combinations
  /// are resolved. Throws InputError, on all ranks, if a dof is constrained twice (but alike) or
  /// depends on itself. Collective.
  Reduction(const RCP<const Map>& map, std::vector<Combination> combinations,
            std::vector<GlobalIndex> given, const NameOf& name_of = {});
  /// Returns this reduction with other velocities b: those of given dofs, and what combinations
  /// have beside their terms; null: zero. Collective.
  Reduction with_velocity(const RCP<const Vector>& velocity) const;

  /// All dofs are unknowns. The same on all ranks, as are the next two.
  bool is_identity() const { return unknowns_.is_null(); }
  bool has_combinations() const { return !combinations_.is_null(); }
  bool has_given() const { return has_given_; }
  /// 1 for unknowns, 0 for other dofs; null: all are unknowns.
  RCP<const Vector> unknowns() const { return unknowns_; }
  /// Do other dofs have unknowns of their own than in `other`? Collective.
  bool differs_in_unknowns(const Reduction& other) const;
  /// b, the velocities of all dofs for y = 0; null: zero.
  RCP<const Vector> offset() const { return offset_; }
  /// Rows of the combinations, by dofs that are unknowns or given; null: none.
  RCP<const CrsMatrix> combinations() const { return combinations_; }
  /// Returns those of these dofs, of any rank, that are combinations, in ascending order.
  /// Collective.
  std::vector<GlobalIndex> combinations_among(const std::vector<GlobalIndex>& dofs) const;

  /// V := P V + b: the unknowns of V are y, all others are replaced. Collective.
  void expand(Vector& velocity) const;
  /// V := P V, for differences of velocities. Collective.
  void expand_change(Vector& change) const;
  /// Combinations from the other dofs, given ones as they are in V. Collective.
  void follow(Vector& velocity) const;
  /// y of V: zero where there is no unknown. Local.
  void select(Vector& velocity) const;
  /// Returns the part of the reactions of `keep_reactions` that holds given dofs, by themselves and
  /// through the combinations of them. Collective.
  RCP<Vector> on_given(const Vector& reactions) const;
  /// q := q without what acts on given dofs. Local.
  void drop_given(Vector& momentum) const;
  /// q := P^T q. Collective.
  void restrict(Vector& momentum) const;
  /// From what a solution leaves in the rows of all dofs, r = C V + B^T p̂ - q: the impulses of the
  /// constraints. At given dofs and combinations that is r, and unknowns feel what combinations of
  /// them take (their own r is the error of the solve). Collective.
  void keep_reactions(Vector& residual) const;

  /// P^T C P with rows of the identity. May change C. Collective.
  RCP<CrsMatrix> reduce(const RCP<CrsMatrix>& matrix) const;
  /// P^T B^T. Collective.
  RCP<const CrsMatrix> reduce_rows(const RCP<const CrsMatrix>& matrix) const;

 private:
  void resolve(const NameOf& name_of);
  void set_combinations(const Vector& source, Vector& velocity) const;
  RCP<CrsMatrix> combined(const CrsMatrix& matrix) const;

  RCP<const Map> map_;
  std::vector<int> given_, combined_;  ///< local rows, ascending
  bool has_given_ = false;
  RCP<const CrsMatrix> combinations_;  ///< resolved; rows of other dofs are empty
  RCP<const CrsMatrix> terms_;         ///< terms as they were handed in
  int n_levels_ = 0;                   ///< depth of combinations of combinations
  RCP<const Vector> unknowns_, offset_;
};

}  // namespace lockstep
