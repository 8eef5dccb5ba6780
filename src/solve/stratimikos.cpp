#include "solve/stratimikos.hpp"

#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Teuchos_AbstractFactoryStd.hpp>
#include <Thyra_Ifpack2PreconditionerFactory.hpp>
#include <Thyra_PreconditionerFactoryHelpers.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"
#include "base/library_message.hpp"
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

}  // namespace lockstep
