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
        solid_block_(replicated(*assembled(system.solids.op))),
        matrix_(solid_block_) {
    const auto n = static_cast<int>(matrix_.rows());
    Vector unit(coupling_->getRangeMap()), force(coupling_->getRangeMap());
    Vector column(coupling_->getDomainMap()), kept(coupling_->getDomainMap());
    if (keep == Keep::columns) {
      columns_ = rcp(new MultiVector(coupling_->getDomainMap(), n));
      rest_ = make_vector(coupling_->getDomainMap());
      of_solid_ = make_vector(coupling_->getRangeMap());
    }
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
  /// As (I - W B^T) M (I - B W^T) + W C W^T with W = M B S^-1, which is definite whatever rounding
  /// does to M: where C is small, Woodbury's difference has nothing else left.
  void apply_woodbury(const Vector& r, Vector& z) const {
    const Eigen::VectorXd velocity = factors_.solve(kept_products(r));
    distribute(velocity, *of_solid_);
    rest_->update(1, r, 0);
    coupling_->apply(*of_solid_, *rest_, Teuchos::TRANS, -1, 1);
    apply(*pressure_inverse_, *rest_, z);
    coupling_->apply(z, *of_solid_);
    const Eigen::VectorXd change = factors_.solve(solid_block_ * velocity - replicated(*of_solid_));
    for (int dof = 0; dof < change.size(); ++dof)
      z.update(change[dof], *columns_->getVector(dof), 1);
  }
  /// (M B)^T r.
  Eigen::VectorXd kept_products(const Vector& r) const {
    Eigen::VectorXd products(matrix_.rows());
    const auto values = r.getData();
    const Eigen::Map<const Eigen::VectorXd> here(values.getRawPtr(), values.size());
    for (int dof = 0; dof < products.size(); ++dof) {
      const auto column = columns_->getData(dof);
      products[dof] =
          here.dot(Eigen::Map<const Eigen::VectorXd>(column.getRawPtr(), column.size()));
    }
    sum_all(r.getMap()->getComm(), products.data(), static_cast<int>(products.size()));
    return products;
  }

  RCP<const CrsMatrix> coupling_;
  RCP<const LinearOperator> pressure_inverse_;
  Eigen::MatrixXd solid_block_, matrix_;  ///< C; C + B^T M B
  Eigen::LLT<Eigen::MatrixXd> factors_;
  RCP<MultiVector> columns_;     ///< M B, if kept, as all below
  RCP<Vector> rest_, of_solid_;  ///< work vectors of `apply_woodbury`
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
