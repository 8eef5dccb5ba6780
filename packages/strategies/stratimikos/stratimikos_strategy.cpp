#include "strategies/stratimikos/stratimikos_strategy.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Teko_InverseFactory.hpp>
#include <Teko_InverseLibrary.hpp>
#include <Teko_RequestCallback.hpp>
#include <Teko_RequestHandler.hpp>
#include <Teuchos_VerboseObject.hpp>
#include <Thyra_DefaultBlockedLinearOp.hpp>
#include <Thyra_DefaultScaledAdjointLinearOp.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_RowMatrixTransposer.hpp>
#include <Tpetra_Vector.hpp>
#include <array>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/stencil_operator.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/solver_list.hpp"
#include "solve/stratimikos_registration.hpp"
#include "strategies/common/assembled_schur.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

namespace {

const std::array<const char*, 4> list_keys = {"Linear Solver Type", "Preconditioner Type",
                                              "Linear Solver Types", "Preconditioner Types"};

/// The part of the strategy's list that Stratimikos reads. Our types of inverses stand in Teko's
/// library under their own names, as those of Stratimikos do.
Teuchos::ParameterList stratimikos_list(const Teuchos::ParameterList& given) {
  Teuchos::ParameterList list("stratimikos");
  for (const char* key : list_keys) {
    if (given.isParameter(key))
      list.setEntry(key, given.getEntry(key));
  }
  if (!list.isType<std::string>("Preconditioner Type") ||
      list.get<std::string>("Preconditioner Type") != "Teko")
    return list;
  Teuchos::ParameterList& library =
      list.sublist("Preconditioner Types").sublist("Teko").sublist("Inverse Factory Library");
  for (const char* type : {"Lockstep Multigrid", "Lockstep Solid", "Incomplete Cholesky"}) {
    if (!library.isParameter(type))
      library.sublist(type).set("Type", std::string(type));
  }
  return list;
}

/// Tells Teko's factories which strategy they work for.
class InversesCallback : public Teko::RequestCallback<BlockInverses*> {
 public:
  explicit InversesCallback(BlockInverses* inverses) : inverses_(inverses) {}
  BlockInverses* request(const Teko::RequestMesg&) override { return inverses_; }
  bool handlesRequest(const Teko::RequestMesg& message) override {
    return message.getName() == block_inverses_request;
  }
  void preRequest(const Teko::RequestMesg&) override {}

 private:
  BlockInverses* inverses_;
};

RCP<const LinearOperator> multiple(double factor, const CrsMatrix& matrix) {
  const auto copy = rcp(new CrsMatrix(matrix, Teuchos::Copy));
  copy->resumeFill();
  copy->scale(factor);
  copy->fillComplete(matrix.getDomainMap(), matrix.getRangeMap());
  return as_operator(RCP<const CrsMatrix>(copy));
}

/// The operator that `op` is a multiple of: factories take the sign off -C.
RCP<const LinearOperator> without_factor(const RCP<const LinearOperator>& op) {
  double factor = 1;
  Thyra::EOpTransp transposed = Thyra::NOTRANS;
  RCP<const LinearOperator> result;
  Thyra::unwrap<double>(op, &factor, &transposed, &result);
  return result;
}

/// Keeps what Trilinos prints while this lives: Teko says there why it fails, and nowhere else.
class PrintedByTrilinos {
 public:
  PrintedByTrilinos() : before_(Teuchos::VerboseObjectBase::getDefaultOStream()) {
    Teuchos::VerboseObjectBase::setDefaultOStream(Teuchos::getFancyOStream(text_));
  }
  ~PrintedByTrilinos() { Teuchos::VerboseObjectBase::setDefaultOStream(before_); }
  PrintedByTrilinos(const PrintedByTrilinos&) = delete;
  PrintedByTrilinos& operator=(const PrintedByTrilinos&) = delete;

  /// The message of the first exception that was printed; empty if there is none.
  std::string first_exception() const {
    const std::string text = text_->str(), mark = "*** THROWN EXCEPTION ***";
    const std::size_t begin = text.find(mark);
    if (begin == std::string::npos)
      return "";
    const std::size_t from = begin + mark.size();
    return text.substr(from, text.find("****", from) - from);
  }

 private:
  RCP<std::ostringstream> text_ = rcp(new std::ostringstream);
  RCP<Teuchos::FancyOStream> before_;
};

/// Runs `action`; what Trilinos throws becomes a SolveError that begins with `what`, unless one of
/// our inverses has failed.
template <typename Action>
auto in_our_words(BlockInverses& inverses, const std::string& what, const Action& action) {
  inverses.failure = nullptr;
  const PrintedByTrilinos printed;
  try {
    return action();
  } catch (const Failure&) {
    throw;
  } catch (const std::exception& error) {
    if (inverses.failure)
      std::rethrow_exception(std::exchange(inverses.failure, nullptr));
    const std::string cause = printed.first_exception();
    throw SolveError(fmt::format(
        "{}: {}", what,
        cause.empty() ? library_message(error) : library_message(std::runtime_error(cause))));
  }
}

}  // namespace

struct StratimikosStrategy::Trilinos {
  RCP<Teko::InverseLibrary> library;
};

ParameterList StratimikosStrategy::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare(list, "Linear Solver Type", std::string("Belos"),
          "Stratimikos' name for the package that iterates; Belos is the one that fits");
  declare(list, "Preconditioner Type", std::string("None"),
          "\"Teko\", whose list in \"Preconditioner Types\" names the inverses, or \"None\"");
  declare_free_sublist(
      list, "Linear Solver Types",
      "Stratimikos' list of that name: in \"Belos\" the \"Solver Type\" (MINRES, "
      "Block GMRES, TFQMR, ...) and its settings in \"Solver Types\". "
      "\"Convergence Tolerance\" there is what one solve of Belos aims at, at most.");
  declare_free_sublist(
      list, "Preconditioner Types",
      "Stratimikos' list of that name: in \"Teko\" the \"Inverse Type\" of the whole system and "
      "the "
      "\"Inverse Factory Library\" that it is in. Besides Teko's own types and MueLu, Ifpack2 and "
      "Belos there are \"SPD Block Diagonal\", \"Lockstep Multigrid\", \"Lockstep Solid\", "
      "\"Lockstep Schur\" and \"Incomplete Cholesky\".");
  return list;
}

namespace {

/// The list that names the multigrid for the strategies' common part; none: no multigrid.
std::optional<Teuchos::ParameterList> multigrid_list(const SolverFacts& facts) {
  if (!facts.multigrid)
    return std::nullopt;
  Teuchos::ParameterList holder;
  Teuchos::ParameterList& list = holder.sublist("Pressure Inverse");
  list.setParameters(*facts.multigrid);
  list.set("Type", "Multigrid");
  list = pressure_inverse_list(holder, "Multigrid");  // checks "Sweeps" and "Cycle"
  list.set("Type", "Automatic");
  return list;
}

SolverFacts checked_facts(const ParameterList& given) {
  register_inverse_types();
  const Teuchos::ParameterList list = stratimikos_list(given);
  check_solver_list(list);
  return solver_facts(list);
}

}  // namespace

StratimikosStrategy::StratimikosStrategy(const ParameterList& given)
    : StratimikosStrategy(with_defaults(given, valid_parameters()),
                          checked_facts(with_defaults(given, valid_parameters()))) {}

StratimikosStrategy::StratimikosStrategy(const ParameterList& complete, const SolverFacts& facts)
    : RefinedStrategy(complete, multigrid_list(facts),
                      facts.wants_explicit_blocks ? PressureOrder::of_the_fluid
                                                  : PressureOrder::of_the_inverse),
      facts_(facts),
      method_(stratimikos_list(complete).sublist("Linear Solver Types").sublist("Belos")),
      trilinos_(std::make_unique<Trilinos>()) {
  if (facts_.inverse.empty())
    return;
  in_our_words(*this, "Teko cannot read its \"Inverse Factory Library\"", [&] {
    trilinos_->library =
        Teko::InverseLibrary::buildFromParameterList(stratimikos_list(complete)
                                                         .sublist("Preconditioner Types")
                                                         .sublist("Teko")
                                                         .sublist("Inverse Factory Library"),
                                                     make_solver_builder());
    const auto handler = rcp(new Teko::RequestHandler);
    handler->addRequestCallback(rcp(new InversesCallback(this)));
    trilinos_->library->setRequestHandler(handler);
  });
}

StratimikosStrategy::~StratimikosStrategy() = default;

/// The inverse of A as the library names it, where that is not ours.
std::string StratimikosStrategy::inverses() const {
  const std::string ours = RefinedStrategy::inverses();
  if (facts_.multigrid || facts_.pressure_inverse.empty())
    return ours;
  return "A: " + facts_.pressure_inverse + (ours.empty() ? "" : "; ") + ours;
}

bool StratimikosStrategy::is_pressure_block(const RCP<const LinearOperator>& op) const {
  return op == set_up_->getBlock(0, 0);
}

bool StratimikosStrategy::is_solid_block(const RCP<const LinearOperator>& op) const {
  return system_->has_solid() && without_factor(op) == without_factor(set_up_->getBlock(1, 1));
}

RCP<const LinearOperator> StratimikosStrategy::schur_multigrid() const {
  if (layout() != nullptr)
    return layout()->schur_inverse();
  if (!facts_.multigrid)
    return Teuchos::null;
  BlockSystem schur = *system_;
  schur.set_blocks(as_operator(schur_with_diagonal(*system_)), system_->coupling_transposed(),
                   system_->solid_block());
  schur.pressure_null_space = system_->null_space;
  Teuchos::ParameterList list;
  list.set("Type", "MueLu");
  return lockstep::pressure_inverse(schur, list);
}

RCP<const BlockedOperator> StratimikosStrategy::operator_for_set_up(
    const BlockSystem& system) const {
  const bool is_matrix_free = layout() != nullptr;
  if (is_matrix_free && !facts_.wants_explicit_blocks)
    return system.op();
  const auto a = assembled(system.pressure_block());
  check_solve(
      !a.is_null(),
      "The list of the strategy stratimikos wants the pressure block of the {} as a matrix, "
      "but it is matrix-free. Name \"Lockstep Multigrid\" for its inverse.",
      system.name);
  const auto regular = regular_pressure_block(system, a);
  const bool is_matrix = stencil_of(system.pressure_block()) == nullptr;
  if (!facts_.wants_explicit_blocks && regular == a && is_matrix)
    return system.op();
  BlockSystem result = system;
  if (!system.has_solid()) {
    result.set_blocks(as_operator(regular));
    return result.op();
  }
  if (!facts_.wants_explicit_blocks) {
    result.set_blocks(as_operator(regular), system.coupling_transposed(), system.solid_block());
    return result.op();
  }
  const auto c = assembled(system.solid_block());
  check_solve(
      !c.is_null(),
      "The list of the strategy stratimikos multiplies blocks with each other, but the solid "
      "block of the {} is matrix-free. Choose \"SPD Block Diagonal\" or \"Block "
      "Gauss-Seidel\".",
      system.name);
  Tpetra::RowMatrixTransposer<double, int, GlobalIndex> transposer(system.coupling_transposed());
  const auto op = Thyra::defaultBlockedLinearOp<double>();
  op->beginBlockFill(2, 2);
  op->setBlock(0, 0, as_operator(regular));
  op->setBlock(0, 1, multiple(-1, *transposer.createTranspose()));
  op->setBlock(1, 0, multiple(-1, *system.coupling_transposed()));
  op->setBlock(1, 1, multiple(-1, *c));
  op->endBlockFill();
  return op;
}

RCP<const LinearOperator> StratimikosStrategy::inverse_of(const RCP<const LinearOperator>& op,
                                                          const std::string& name) {
  return in_our_words(
      *this,
      fmt::format(
          "Teko cannot build the inverse \"{}\" for the {} (a value of the wrong type, such "
          "as a double where an int is wanted, ends here too)",
          name, system_->name),
      [&]() -> RCP<const LinearOperator> {
        return Teko::buildInverse(*trilinos_->library->getInverseFactory(name), op);
      });
}

bool StratimikosStrategy::is_built_for(const BlockSystem& system) const {
  if (system.has_solid())
    return flat_ != nullptr;
  return layout() != nullptr || facts_.pressure_inverse.empty() || !fluid_inverse_.is_null();
}

void StratimikosStrategy::build(const BlockSystem& system, bool geometry_changed,
                                bool solid_changed) {
  if (geometry_changed)
    fluid_inverse_ = Teuchos::null;
  if (geometry_changed || solid_changed) {
    preconditioner_ = Teuchos::null;
    flat_.reset();
  }
  if (is_built_for(system))
    return;
  system_ = &system;
  if (!system.has_solid()) {
    const auto op = operator_for_set_up(system);
    const auto kept = std::exchange(set_up_, op);
    fluid_inverse_ = inverse_of(op->getBlock(0, 0), facts_.pressure_inverse);
    if (check_symmetry())
      check_symmetric_positive(*fluid_inverse_, "pressure block of the " + system.name,
                               symmetry_tolerance());
    set_up_ = kept;
    return;
  }
  flat_ = std::make_unique<FlatSystem>(system);
  if (facts_.inverse.empty())
    return;
  set_up_ = operator_for_set_up(system);
  preconditioner_ = inverse_of(set_up_, facts_.inverse);
  if (check_symmetry() && method_.is_symmetric())
    check_symmetric_positive(*flat_->scaled(preconditioner_, 1),
                             "preconditioner of the " + system.name, symmetry_tolerance());
}

int StratimikosStrategy::correct(const BlockSystem& system, const CorrectionRequest& request,
                                 Vector& correction) {
  if (system.has_solid()) {
    const auto presumes = method_.is_symmetric() ? Presumes::symmetry : Presumes::nothing;
    return method_.correct(system, *flat_, preconditioner_, *request.residual,
                           block_krylov(system, request, presumes), correction);
  }
  if (layout() != nullptr)
    return pressure_cg(system, request, correction);
  return conjugate_gradients(
      [&](const Vector& x, Vector& y) { apply(*system.pressure_block(), x, y); },
      [&](const Vector& x, Vector& y) {
        if (fluid_inverse_.is_null())
          y.update(1, x, 0);
        else
          apply(*fluid_inverse_, x, y);
      },
      *request.residual, correction,
      {request.name, request.target, request.maximum_iterations, iteration_null_space(system),
       request.update_target});
}

}  // namespace lockstep
