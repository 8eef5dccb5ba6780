#pragma once
#include "interfaces/strategy.hpp"

namespace lockstep {

/// Eq. 16 as Belos is given it: one vector (p̂, V_S / t), whose two parts are views. A rank without
/// pressures owns solid rows all the same (every rank owns one, see SolidSystem): Belos' inner
/// products of blocked vectors go wrong where a rank owns no row of a block. The factor t makes the
/// residuals of both rows mean the same to a method that stops by one norm of both.
class FlatSystem {
 public:
  /// Makes the flat space of a system with solids. Throws SolveError if some rank owns no row at
  /// all. Collective.
  explicit FlatSystem(const BlockSystem& system);

  const RCP<const Map>& map() const { return map_; }
  /// factor * D op D with D = diag(1, t), for an operator on blocked vectors. Shares work vectors
  /// with the operators that it made before.
  RCP<const LinearOperator> scaled(const RCP<const LinearOperator>& op, double t,
                                   double factor = 1) const;
  /// The view of p̂ in a flat vector; shares the values.
  RCP<const Vector> pressure_part(const Vector& flat) const;
  RCP<Vector> pressure_part(Vector& flat) const;

 private:
  RCP<const Map> map_, pressure_map_, solid_map_;
  RCP<Vector> solid_;  ///< t times the solid part of what an operator is applied to
};

}  // namespace lockstep
