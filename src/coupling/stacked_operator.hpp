#pragma once
#include <Tpetra_Operator.hpp>
#include <vector>

#include "coupling/reduction.hpp"
#include "linear/types.hpp"

namespace lockstep {

/// Operators of one model in the stack of all solids, and their place there.
struct StackedPart {
  RCP<const LinearOperator> mass;
  RCP<const LinearOperator> implicit_force;  ///< D, or null
  RCP<const Map> map;
  GlobalIndex id_begin = 0;  ///< first id of the part among those of the stack
  int local_begin = 0;       ///< first row of the part among this rank's
};

/// Rows of the identity in an operator on the stack: of dofs that are no unknowns, and padding.
struct IdentityRows {
  Reduction reduction;
  std::vector<int> padding;  ///< local rows
};

/// blockdiag(mass_m - dt D_m) + added, reduced if asked, applied without forming anything: the
/// solid block when a model gives no assembled matrix. The parts' local rows follow one another in
/// the map.
class StackedOperator : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  /// `added` may be null.
  StackedOperator(std::vector<StackedPart> parts, double dt, RCP<const CrsMatrix> added,
                  RCP<const Map> map, IdentityRows identity = {});

  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode, double alpha,
             double beta) const override;

 private:
  void apply_to(const Vector& x, Vector& y) const;

  std::vector<StackedPart> parts_;
  double dt_;
  RCP<const CrsMatrix> added_;
  RCP<const Map> map_;
  IdentityRows identity_;
};

/// Thyra view of a Tpetra operator.
RCP<const LinearOperator> as_thyra(const RCP<const Tpetra::Operator<double, int, GlobalIndex>>& op);

}  // namespace lockstep
