#include "solve/soft/muelu_multigrid.hpp"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "linear/action_operator.hpp"

namespace lockstep {

RCP<const LinearOperator> muelu_multigrid(const RCP<CrsMatrix>& matrix, int n_equations,
                                          const RCP<MultiVector>& near_null_space,
                                          const Teuchos::ParameterList& list,
                                          const std::string& name) {
  using Operator = Tpetra::Operator<double, int, GlobalIndex>;
  Teuchos::ParameterList parameters(list);
  parameters.set("number of equations", n_equations);
  parameters.sublist("user data").set("Nullspace", near_null_space);
  try {
    const RCP<Operator> given = matrix;
    const auto inverse = MueLu::CreateTpetraPreconditioner(given, parameters);
    // MueLu's operator ignores the factors of y = alpha M x + beta y.
    return action_operator(matrix->getRowMap(),
                           [inverse](const Vector& x, Vector& y) { inverse->apply(x, y); });
  } catch (const std::exception& error) {
    throw SolveError(fmt::format("MueLu cannot build a preconditioner for the {}: {}", name,
                                 library_message(error)));
  }
}

}  // namespace lockstep
