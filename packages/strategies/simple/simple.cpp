#include "strategies/simple/simple.hpp"

#include <Teko_InverseFactory.hpp>
#include <Teko_SIMPLEPreconditionerFactory.hpp>
#include <Teko_Utilities.hpp>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

namespace {

RCP<const LinearOperator> scaled_copy(double factor, const CrsMatrix& matrix) {
  const auto copy = rcp(new CrsMatrix(matrix, Teuchos::Copy));
  copy->resumeFill();
  copy->scale(factor);
  copy->fillComplete(matrix.getDomainMap(), matrix.getRangeMap());
  return as_operator(RCP<const CrsMatrix>(copy));
}

/// [s^2 A, -s t B; -s t B^T, -t^2 C] around its first block, each a matrix of its own, as Teko
/// needs them to multiply them.
RCP<const LinearOperator> explicit_blocks(const RCP<const LinearOperator>& pressure_block,
                                          const BlockSystem& system, double s, double t) {
  Tpetra::RowMatrixTransposer<double, int, GlobalIndex> transposer(system.coupling_transposed);
  return Thyra::block2x2<double>(pressure_block, scaled_copy(-s * t, *transposer.createTranspose()),
                                 scaled_copy(-s * t, *system.coupling_transposed),
                                 scaled_copy(-t * t, *assembled(system.solids.op)));
}

/// Teko asks for the inverse of A and for that of its (negative definite) Schur complement.
class Inverses : public Teko::InverseFactory {
 public:
  Inverses(const RCP<const LinearOperator>& pressure_block,
           const RCP<const LinearOperator>& pressure_inverse, const std::string& name)
      : pressure_block_(pressure_block), pressure_inverse_(pressure_inverse), name_(name) {}

  Teko::InverseLinearOp buildInverse(const Teko::LinearOp& op) const override {
    return Teuchos::rcp_const_cast<Thyra::LinearOpBase<double>>(inverse_of(op));
  }
  Teko::InverseLinearOp buildInverse(const Teko::LinearOp& op,
                                     const Teko::LinearOp&) const override {
    return buildInverse(op);
  }
  void rebuildInverse(const Teko::LinearOp& op, Teko::InverseLinearOp& inverse) const override {
    inverse = buildInverse(op);
  }
  RCP<const Teuchos::ParameterList> getParameterList() const override {
    return Teuchos::parameterList();
  }
  std::string toString() const override { return "inverses of the strategy simple"; }

 private:
  RCP<const LinearOperator> inverse_of(const Teko::LinearOp& op) const {
    if (op == pressure_block_)
      return pressure_inverse_;
    const auto matrix = assembled(op);
    LOCKSTEP_ASSERT(!matrix.is_null());
    return Thyra::scale<double>(-1.0, exact_inverse(scaled_copy(-1, *matrix), name_));
  }

  RCP<const LinearOperator> pressure_block_, pressure_inverse_;
  std::string name_;
};

}  // namespace

ParameterList Simple::valid_parameters() {
  ParameterList list = gmres_parameters();
  declare_between(list, "Relaxation", 1.0, 0.01, 1.0,
                  "Factor of the pressure correction by the solid [1]");
  return list;
}

Simple::Simple(const ParameterList& given)
    : GmresStrategy(with_defaults(given, valid_parameters()),
                    pressure_inverse_list(given, "Automatic"), PressureOrder::of_the_fluid),
      relaxation_(with_defaults(given, valid_parameters()).get<double>("Relaxation")) {}

RCP<const LinearOperator> Simple::make_preconditioner(const BlockSystem& system,
                                                      const ScaledSystem& scaled) {
  const auto a = assembled(system.pressure.op), c = assembled(system.solids.op);
  check_solve(!a.is_null() && !c.is_null(),
              "The strategy simple refuses the {}: a block is matrix-free, but it needs both "
              "assembled. Choose schur-cg.",
              system.name);
  const double s = scaled.s;
  const auto pressure_block = scaled_copy(s * s, *with_filled_rows(system, a));
  const auto blocks = explicit_blocks(pressure_block, system, s, scaled.t);
  const auto inverses =
      rcp(new Inverses(pressure_block, Thyra::scale<double>(1 / (s * s), pressure_inverse()),
                       "solid Schur complement of the " + system.name));
  const Teko::NS::SIMPLEPreconditionerFactory factory(inverses, relaxation_);
  return Thyra::prec<double>(factory, blocks)->getUnspecifiedPrecOp();
}

}  // namespace lockstep
