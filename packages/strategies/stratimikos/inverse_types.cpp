#include <Teko_CloneFactory.hpp>
#include <Teko_InverseFactory.hpp>
#include <Teko_InverseLibrary.hpp>
#include <Teko_PreconditionerFactory.hpp>
#include <Teko_Utilities.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "solve/incomplete_cholesky.hpp"
#include "solve/preconditioner.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "strategies/common/assembled_schur.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/woodbury.hpp"
#include "strategies/stratimikos/block_inverses.hpp"

namespace lockstep {

namespace {

/// factor * op; a block of Eq. 16 has factor 1 (A) or -1 (C).
struct SignedOperator {
  RCP<const LinearOperator> op;
  double factor = 1;
};

/// Makes `op` positive definite: takes the factor off, and negates a matrix whose diagonal is
/// negative, as that of an assembled Schur complement -C - B^T D B is.
SignedOperator made_positive(const Teko::LinearOp& op) {
  SignedOperator result;
  Thyra::EOpTransp transposed = Thyra::NOTRANS;
  Thyra::unwrap<double>(op, &result.factor, &transposed, &result.op);
  const auto matrix = assembled(result.op);
  if (matrix.is_null() || diagonal_of(*matrix)->meanValue() >= 0)
    return result;
  const auto negated = rcp(new CrsMatrix(*matrix, Teuchos::Copy));
  negated->resumeFill();
  negated->scale(-1);
  negated->fillComplete(matrix->getDomainMap(), matrix->getRangeMap());
  return {as_operator(RCP<const CrsMatrix>(negated)), -result.factor};
}

RCP<const LinearOperator> with_factor(double factor, const RCP<const LinearOperator>& inverse) {
  return factor == 1 ? inverse : Thyra::scale<double>(1 / factor, inverse);
}

/// The base of the four types: it finds the strategy behind the library, and keeps the message of a
/// failure, which Teko would lose.
class InverseType : public Teko::PreconditionerFactory {
 public:
  void initializeFromParameterList(const Teuchos::ParameterList& list) override { list_ = list; }

  Teko::LinearOp buildPreconditionerOperator(Teko::LinearOp& op,
                                             Teko::PreconditionerState&) const override {
    auto& inverses =
        *getRequestHandler()->request<BlockInverses*>(Teko::RequestMesg(block_inverses_request));
    try {
      return make(inverses, op);
    } catch (...) {
      if (!inverses.failure)
        inverses.failure = std::current_exception();
      throw;
    }
  }

 protected:
  virtual RCP<const LinearOperator> make(BlockInverses& inverses,
                                         const Teko::LinearOp& op) const = 0;
  const Teuchos::ParameterList& list() const { return list_; }
  /// A parameter of the list, or `standard` where it is not given.
  template <typename T>
  T value_of(const char* name, T standard) const {
    check_input(!list_.isParameter(name) || list_.isType<T>(name),
                "Teko's \"Inverse Factory Library\", \"{}\": \"{}\" must be of type {}.",
                list_.name(), name, Teuchos::TypeNameTraits<T>::name());
    return list_.isParameter(name) ? list_.get<T>(name) : standard;
  }

 private:
  Teuchos::ParameterList list_;
};

class MultigridType : public InverseType {
  RCP<const LinearOperator> make(BlockInverses& inverses, const Teko::LinearOp& op) const override {
    check_input(inverses.is_pressure_block(op),
                "The inverse \"Lockstep Multigrid\" is one of the pressure block A alone; another "
                "block wants \"Lockstep Solid\", MueLu or Ifpack2.");
    return inverses.multigrid();
  }
};

class SolidType : public InverseType {
  RCP<const LinearOperator> make(BlockInverses& inverses, const Teko::LinearOp& op) const override {
    const bool is_exact = value_of("Exact", false);
    const SignedOperator block = made_positive(op);
    const auto inverse = [&]() -> RCP<const LinearOperator> {
      const bool is_own = inverses.is_solid_block(op);
      const std::string name = (is_own ? "solid block of the " : "solid Schur complement of the ") +
                               inverses.system().name;
      if (list().isSublist("Inverse"))
        return preconditioner_from_list(
            block.op, list().sublist("Inverse"), name,
            is_own ? inverses.system().near_null_space : NearNullSpace());
      if (!is_own)
        return exact_inverse(block.op, name);
      return is_exact ? inverses.solid().exact() : inverses.solid().approximate();
    };
    return with_factor(block.factor, inverse());
  }
};

class SchurType : public InverseType {
  RCP<const LinearOperator> make(BlockInverses& inverses, const Teko::LinearOp& op) const override {
    const BlockSystem& system = inverses.system();
    check_input(inverses.is_pressure_block(op),
                "The inverse \"Lockstep Schur\" stands for that of the pressure block A.");
    const auto factory =
        getInverseLibrary()->getInverseFactory(list().get<std::string>("Inverse Type"));
    WoodburyLimits limits;
    limits.most_unknowns = value_of("Largest Solid", limits.most_unknowns);
    limits.least_added_mass = value_of("Least Added Mass", limits.least_added_mass);
    const auto inverse_of = [&factory](const Teko::LinearOp& matrix) {
      return Teko::LinearOp(Teko::buildInverse(*factory, matrix));
    };
    if (!system.has_solid())
      return inverse_of(op);
    if (const auto few = woodbury_inverse_within(limits, system, [&] { return inverse_of(op); });
        !few.is_null())
      return few;
    if (const auto multigrid = inverses.schur_multigrid(); !multigrid.is_null())
      return multigrid;
    const auto matrix = schur_with_diagonal(system);
    BlockSystem schur = system;
    schur.set_blocks(as_operator(matrix), system.coupling_transposed(), system.solid_block());
    schur.pressure_null_space = system.null_space;
    return inverse_of(as_operator(regular_pressure_block(schur, matrix)));
  }
};

class IncompleteCholeskyType : public InverseType {
  RCP<const LinearOperator> make(BlockInverses& inverses, const Teko::LinearOp& op) const override {
    const SignedOperator block = made_positive(op);
    const auto matrix = assembled(block.op);
    check_solve(!matrix.is_null(),
                "The inverse \"Incomplete Cholesky\" needs an assembled matrix, but a block of the "
                "{} is matrix-free.",
                inverses.system().name);
    return with_factor(block.factor, incomplete_cholesky_inverse(
                                         matrix, "block of the " + inverses.system().name));
  }
};

template <typename Type>
void add(const std::string& name) {
  Teko::PreconditionerFactory::addPreconditionerFactory(name, rcp(new Teko::AutoClone<Type>));
}

}  // namespace

void register_inverse_types() {
  static const bool registered = [] {
    add<MultigridType>("Lockstep Multigrid");
    add<SolidType>("Lockstep Solid");
    add<SchurType>("Lockstep Schur");
    add<IncompleteCholeskyType>("Incomplete Cholesky");
    return true;
  }();
  static_cast<void>(registered);
}

}  // namespace lockstep
