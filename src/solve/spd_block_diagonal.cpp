#include <Teko_BlockPreconditionerFactory.hpp>
#include <Teko_CloneFactory.hpp>
#include <Teko_InverseFactory.hpp>
#include <Teko_InverseLibrary.hpp>
#include <Teko_NeumannSeriesPreconditionerFactory.hpp>
#include <Teko_StratimikosFactory.hpp>
#include <Teko_Utilities.hpp>
#include <Teuchos_AbstractFactoryStd.hpp>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_ScaledAdjointLinearOpBase.hpp>

#include "base/errors.hpp"
#include "solve/stratimikos_registration.hpp"

namespace lockstep {

namespace {

/// The preconditioner diag(A^-1, C^-1) of [A, -B; -B^T, -C], symmetric positive definite as MINRES
/// wants it. Each inverse is one of Teko's inverse library.
class SpdBlockDiagonal : public Teko::BlockPreconditionerFactory {
 public:
  RCP<Teko::PreconditionerState> buildPreconditionerState() const override {
    return rcp(new State);
  }

  Teko::LinearOp buildPreconditionerOperator(Teko::BlockedLinearOp& blocks,
                                             Teko::BlockPreconditionerState& state) const override {
    auto& kept = dynamic_cast<State&>(state);
    update(*pressure_factory_, Teko::getBlock(0, 0, blocks), kept.pressure_inverse);
    update(*solid_factory_, solid_block(blocks), kept.solid_inverse);
    return Thyra::block2x2<double>(kept.pressure_inverse, Teuchos::null, Teuchos::null,
                                   kept.solid_inverse);
  }

  void initializeFromParameterList(const Teuchos::ParameterList& list) override {
    const auto library = getInverseLibrary();
    pressure_factory_ = library->getInverseFactory(list.get<std::string>("Fluid Inverse Type"));
    solid_factory_ = library->getInverseFactory(list.get<std::string>("Solid Inverse Type"));
  }

 private:
  /// Inverses that survive from one system to the next.
  struct State : Teko::BlockPreconditionerState {
    Teko::InverseLinearOp pressure_inverse, solid_inverse;
  };

  static void update(const Teko::InverseFactory& factory, const Teko::LinearOp& op,
                     Teko::InverseLinearOp& inverse) {
    if (inverse.is_null())
      inverse = Teko::buildInverse(factory, op);
    else
      Teko::rebuildInverse(factory, op, inverse);
  }

  /// C itself: the block is -C, which no SPD inverse takes.
  static Teko::LinearOp solid_block(const Teko::BlockedLinearOp& blocks) {
    double factor = 0;
    Thyra::EOpTransp transposed = Thyra::NOTRANS;
    Teko::LinearOp solid;
    Thyra::unwrap<double>(Teko::getBlock(1, 1, blocks), &factor, &transposed, &solid);
    check_solve(factor < 0,
                "The Teko factory \"SPD Block Diagonal\" wants a (2,2) block of the form "
                "scale(-1, C), but its factor is {}.",
                factor);
    return factor == -1 ? solid : Thyra::scale<double>(-factor, solid);
  }

  RCP<Teko::InverseFactory> pressure_factory_, solid_factory_;
};

}  // namespace

void register_teko(Stratimikos::DefaultLinearSolverBuilder& builder) {
  static const bool registered = [] {
    Teko::PreconditionerFactory::addPreconditionerFactory(
        "SPD Block Diagonal", rcp(new Teko::AutoClone<SpdBlockDiagonal>));
    return true;
  }();
  static_cast<void>(registered);
  // Teko adds this one itself only to a builder of its own.
  builder.setPreconditioningStrategyFactory(
      Teuchos::abstractFactoryStd<Thyra::PreconditionerFactoryBase<double>,
                                  Teko::NeumannSeriesPreconditionerFactory<double>>(),
      "Neumann Series");
  Teko::addTekoToStratimikosBuilder(builder, "Teko");
}

}  // namespace lockstep
