#include "solve/stratimikos.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Teuchos_AbstractFactoryStd.hpp>
#include <Thyra_Ifpack2PreconditionerFactory.hpp>
#include <Thyra_LinearOpWithSolveFactoryHelpers.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "solve/solver_list.hpp"
#include "solve/stratimikos_registration.hpp"

namespace lockstep {

namespace {

void register_ifpack2(Stratimikos::DefaultLinearSolverBuilder& builder) {
  using Factory = Thyra::Ifpack2PreconditionerFactory<CrsMatrix>;
  builder.setPreconditioningStrategyFactory(
      Teuchos::abstractFactoryStd<Thyra::PreconditionerFactoryBase<double>, Factory>(), "Ifpack2");
}

}  // namespace

RCP<Stratimikos::DefaultLinearSolverBuilder> make_solver_builder() {
  const auto builder = rcp(new Stratimikos::DefaultLinearSolverBuilder);
  register_ifpack2(*builder);
  register_muelu(*builder);
  register_teko(*builder);
  return builder;
}

RCP<const LinearOperator> stratimikos_preconditioner(const RCP<const LinearOperator>& op,
                                                     const std::string& type,
                                                     const Teuchos::ParameterList& list,
                                                     const std::string& name) {
  const auto all = Teuchos::parameterList();
  all->set("Preconditioner Type", type);
  all->sublist("Preconditioner Types").sublist(type).setParameters(list);
  try {
    Stratimikos::DefaultLinearSolverBuilder builder;
    if (type == "MueLu")
      register_muelu(builder);
    else
      register_ifpack2(builder);
    builder.setParameterList(all);
    const auto factory = builder.createPreconditioningStrategy("");
    return Thyra::prec<double>(*factory, op)->getUnspecifiedPrecOp();
  } catch (const std::exception& error) {
    throw SolveError(fmt::format("{} cannot build a preconditioner for the {}: {}", type, name,
                                 library_message(error)));
  }
}

RCP<Thyra::LinearOpWithSolveBase<double>> linear_op_with_solve(const RCP<const LinearOperator>& op,
                                                               const Teuchos::ParameterList& list) {
  check_solver_list(list);
  try {
    const auto builder = make_solver_builder();
    builder->setParameterList(Teuchos::parameterList(list));
    const auto factory = builder->createLinearSolveStrategy("");
    factory->setVerbLevel(Teuchos::VERB_NONE);
    auto solver = Thyra::linearOpWithSolve<double>(*factory, op);
    // The solver refers to sublists that only the builder owns.
    Teuchos::set_extra_data(builder, "builder", Teuchos::inOutArg(solver));
    return solver;
  } catch (const Failure&) {
    throw;
  } catch (const std::exception& error) {
    throw SolveError(
        fmt::format("Stratimikos cannot set up the solver \"{}\": {}. Values of the wrong type (a "
                    "double where an "
                    "int is wanted) inside the lists of Ifpack2 and MueLu end here as well.",
                    list.name(), library_message(error)));
  }
}

}  // namespace lockstep
