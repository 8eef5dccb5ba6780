#pragma once
#include <array>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "linear/matrix_part.hpp"
#include "linear/near_null_space.hpp"

namespace lockstep {

struct RowComponent;

/// The inverse of a symmetric positive definite C, component by component of its nonzeros: exact
/// where that is cheap (dense blocks for the 6 x 6 of rigid bodies, sparse Cholesky factors for
/// cloths and small volumes), while the rest is left to iterations, one for each large component,
/// so that none suffers from what the others are like.
class InverseByCost {
 public:
  /// Rows left to an iteration.
  struct Rest {
    RCP<const LinearOperator> op;            ///< C on them, numbered anew
    NearNullSpace motions;                   ///< the rigid motions of bodies in them
    double stiffness = 1;                    ///< stiffness_number; 1 where C is matrix-free
    std::shared_ptr<const MatrixPart> part;  ///< null: all rows
  };
  using InverseOfRest = std::function<RCP<const LinearOperator>(const Rest&)>;

  /// Rows, entries and most multiplications of components that were found to cost more.
  using Costly = std::set<std::array<double, 3>>;

  /// Where `space` tells how stiff a large component is, it is factored only if an iteration would
  /// be slow. `name` is for messages. `costly`, if given, is kept from one C to the next, so that
  /// what costs too much is found out once. Throws SolveError if C is not positive definite.
  /// Collective.
  InverseByCost(const RCP<const LinearOperator>& op, const NearNullSpace& space,
                const std::string& name, Costly* costly = nullptr);

  /// Nothing is left.
  bool is_complete() const { return rests_.empty(); }
  const std::vector<Rest>& rests() const { return rests_; }
  /// The exact inverse of such a rest, if its factors are cheap to apply, as those of sheets are;
  /// else null. For preconditioners, where one application saves many steps of an outer iteration.
  /// Collective.
  RCP<const LinearOperator> cheap_factors(const Rest& rest) const;
  /// C^-1 with these inverses of what is left, on the rows of C. Applying it is collective.
  RCP<const LinearOperator> with(const InverseOfRest& inverse_of_rest) const;

 private:
  void split(const RCP<const CrsMatrix>& matrix, const NearNullSpace& space);
  void take_small(const CrsMatrix& matrix, const NearNullSpace& space,
                  const std::vector<RowComponent>& components, std::vector<bool> is_small);
  void take_large(const CrsMatrix& matrix, const NearNullSpace& space,
                  const std::vector<bool>& rows);
  RCP<const LinearOperator> factors(const Rest& rest, double most_operations) const;

  RCP<const Map> map_;
  std::string name_;
  RCP<const LinearOperator> whole_;  ///< C^-1, if one method serves all of it
  std::vector<PartInverse> cheap_;
  std::vector<Rest> rests_;
  Costly* costly_;
};

}  // namespace lockstep
