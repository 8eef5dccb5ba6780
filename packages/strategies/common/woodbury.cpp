#include "strategies/common/woodbury.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/symmetry_check.hpp"
#include "strategies/common/small_dense.hpp"

namespace lockstep {

namespace {

class Woodbury {
 public:
  Woodbury(const BlockSystem& system, const RCP<const LinearOperator>& pressure_inverse)
      : coupling_(system.coupling_transposed()),
        pressure_inverse_(pressure_inverse),
        solid_block_(replicated(*assembled(system.solid_block()))),
        rest_(make_vector(coupling_->getDomainMap())),
        of_solid_(make_vector(coupling_->getRangeMap())) {
    const auto n = static_cast<int>(solid_block_.rows());
    columns_ = rcp(new MultiVector(coupling_->getDomainMap(), n));
    Eigen::MatrixXd schur = solid_block_;
    Vector unit(coupling_->getRangeMap());
    for (int dof = 0; dof < n; ++dof) {
      unit.putScalar(0);
      if (unit.getMap()->isNodeGlobalElement(dof))
        unit.replaceGlobalValue(dof, 1.0);
      coupling_->apply(unit, *rest_, Teuchos::TRANS);
      const RCP<Vector> column = columns_->getVectorNonConst(dof);
      apply(*pressure_inverse_, *rest_, *column);
      coupling_->apply(*column, *of_solid_);
      schur.col(dof) += replicated(*of_solid_);
    }
    factors_.compute(0.5 * (schur + schur.transpose()));
    check_solve(factors_.info() == Eigen::Success,
                "C + B^T M B of the {} is not positive definite: the approximate inverse M of A is "
                "not, or C is not.",
                system.name);
  }

  /// As (I - W B^T) M (I - B W^T) + W C W^T with W = M B Ŝ^-1, which is definite whatever rounding
  /// does to M: where C is small, Woodbury's difference has nothing else left.
  void apply_to(const Vector& r, Vector& z) const {
    const Eigen::VectorXd velocity = factors_.solve(products_of_columns(r));
    distribute(velocity, *of_solid_);
    rest_->update(1, r, 0);
    coupling_->apply(*of_solid_, *rest_, Teuchos::TRANS, -1, 1);
    apply(*pressure_inverse_, *rest_, z);
    coupling_->apply(z, *of_solid_);
    const Eigen::VectorXd change = factors_.solve(solid_block_ * velocity - replicated(*of_solid_));
    for (int dof = 0; dof < change.size(); ++dof)
      z.update(change[dof], *columns_->getVector(dof), 1);
  }

  RCP<const Map> map() const { return coupling_->getDomainMap(); }

 private:
  /// (M B)^T r.
  Eigen::VectorXd products_of_columns(const Vector& r) const {
    Eigen::VectorXd products(solid_block_.rows());
    const auto values = r.getData();
    const Eigen::Map<const Eigen::VectorXd> here(values.getRawPtr(), values.size());
    for (int dof = 0; dof < products.size(); ++dof) {
      const auto column = columns_->getData(dof);
      products[dof] =
          here.dot(Eigen::Map<const Eigen::VectorXd>(column.getRawPtr(), column.size()));
    }
    sum_over_ranks(r.getMap()->getComm(), products);
    return products;
  }

  RCP<const CrsMatrix> coupling_;
  RCP<const LinearOperator> pressure_inverse_;
  Eigen::MatrixXd solid_block_;          ///< C
  Eigen::LLT<Eigen::MatrixXd> factors_;  ///< factors of Ŝ
  RCP<MultiVector> columns_;             ///< M B
  RCP<Vector> rest_, of_solid_;          ///< work vectors
};

/// Largest eigenvalue of C^-1 B^T M B, from below.
double added_mass(const BlockSystem& system, const LinearOperator& pressure_inverse) {
  const CrsMatrix& coupling = *system.coupling_transposed();
  const Eigen::MatrixXd solid_block = replicated(*assembled(system.solid_block()));
  const Eigen::LLT<Eigen::MatrixXd> factors(solid_block);
  Vector velocity(coupling.getRangeMap()), impulse(coupling.getRangeMap());
  Vector divergence(coupling.getDomainMap()), pressure(coupling.getDomainMap());
  pseudo_random(velocity, 1);
  double largest = 0;
  constexpr int n_steps = 3;
  for (int step = 0; step < n_steps; ++step) {
    const Eigen::VectorXd before = replicated(velocity);
    coupling.apply(velocity, divergence, Teuchos::TRANS);
    apply(pressure_inverse, divergence, pressure);
    coupling.apply(pressure, impulse);
    const Eigen::VectorXd added = replicated(impulse);
    largest = std::max(largest, before.dot(added) / before.dot(solid_block * before));
    const Eigen::VectorXd after = factors.solve(added);
    if (after.norm() == 0)
      break;
    distribute(after / after.norm(), velocity);
  }
  return largest;
}

}  // namespace

RCP<const LinearOperator> woodbury_inverse_within(
    const WoodburyLimits& limits, const BlockSystem& system,
    const std::function<RCP<const LinearOperator>()>& make_pressure_inverse) {
  if (system.solid_block()->domain()->dim() > limits.most_unknowns ||
      assembled(system.solid_block()).is_null())
    return Teuchos::null;
  const auto pressure_inverse = make_pressure_inverse();
  return added_mass(system, *pressure_inverse) < limits.least_added_mass
             ? Teuchos::null
             : woodbury_inverse(system, pressure_inverse);
}

RCP<const LinearOperator> woodbury_inverse(const BlockSystem& system,
                                           const RCP<const LinearOperator>& pressure_inverse) {
  const auto woodbury = std::make_shared<const Woodbury>(system, pressure_inverse);
  return action_operator(woodbury->map(),
                         [woodbury](const Vector& r, Vector& z) { woodbury->apply_to(r, z); });
}

}  // namespace lockstep
