#include "strategies/common/solid_schur.hpp"

#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "strategies/common/small_dense.hpp"

namespace lockstep {

namespace {

class DenseSolidSchur : public SolidSchur, public std::enable_shared_from_this<DenseSolidSchur> {
 public:
  DenseSolidSchur(const BlockSystem& system, const RCP<const LinearOperator>& pressure_inverse,
                  Keep keep)
      : coupling_(system.coupling_transposed),
        pressure_inverse_(pressure_inverse),
        matrix_(replicated(*assembled(system.solids.op))) {
    const auto n = static_cast<int>(matrix_.rows());
    Vector unit(coupling_->getRangeMap()), force(coupling_->getRangeMap());
    Vector column(coupling_->getDomainMap()), kept(coupling_->getDomainMap());
    if (keep == Keep::columns)
      columns_ = rcp(new MultiVector(coupling_->getDomainMap(), n));
    for (int dof = 0; dof < n; ++dof) {
      unit.putScalar(0);
      if (unit.getMap()->isNodeGlobalElement(dof))
        unit.replaceGlobalValue(dof, 1.0);
      coupling_->apply(unit, column, Teuchos::TRANS);
      apply(*pressure_inverse_, column, kept);
      coupling_->apply(kept, force);
      matrix_.col(dof) += replicated(force);
      if (keep == Keep::columns)
        columns_->getVectorNonConst(dof)->update(1, kept, 0);
    }
    matrix_ = (0.5 * (matrix_ + matrix_.transpose())).eval();
    factors_.compute(matrix_);
    check_solve(factors_.info() == Eigen::Success,
                "C + B^T M B of the {} is not positive definite: the approximate inverse M of A is "
                "not, or C is not.",
                system.name);
  }

  RCP<const LinearOperator> inverse() const override {
    return action_operator(coupling_->getRangeMap(),
                           [self = shared_from_this()](const Vector& force, Vector& velocity) {
                             distribute(self->factors_.solve(replicated(force)), velocity);
                           });
  }

  RCP<const LinearOperator> woodbury() const override {
    return action_operator(
        coupling_->getDomainMap(),
        [self = shared_from_this()](const Vector& r, Vector& z) { self->apply_woodbury(r, z); });
  }

 private:
  void apply_woodbury(const Vector& r, Vector& z) const {
    apply(*pressure_inverse_, r, z);
    Vector force(coupling_->getRangeMap());
    coupling_->apply(z, force);
    const Eigen::VectorXd velocity = factors_.solve(replicated(force));
    for (int dof = 0; dof < velocity.size(); ++dof)
      z.update(-velocity[dof], *columns_->getVector(dof), 1);
  }

  RCP<const CrsMatrix> coupling_;
  RCP<const LinearOperator> pressure_inverse_;
  Eigen::MatrixXd matrix_;
  Eigen::LLT<Eigen::MatrixXd> factors_;
  RCP<MultiVector> columns_;  ///< M B, if kept
};

}  // namespace

std::shared_ptr<const SolidSchur> SolidSchur::make(
    const BlockSystem& system, const RCP<const LinearOperator>& pressure_inverse, int largest,
    const std::string& who, Keep keep) {
  const auto n = system.solids.op->domain()->dim();
  check_solve(
      n <= largest,
      "The strategy {} refuses the {}: it inverts A once for each of the {} solid unknowns, "
      "and \"Largest Solid\" is {}. Raise it, or choose schur-cg.",
      who, system.name, n, largest);
  check_solve(!assembled(system.solids.op).is_null(),
              "The strategy {} refuses the {}: its solid block is matrix-free. Choose schur-cg.",
              who, system.name);
  return std::make_shared<DenseSolidSchur>(system, pressure_inverse, keep);
}

}  // namespace lockstep
