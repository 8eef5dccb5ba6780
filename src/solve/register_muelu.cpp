#include <MueLu_MasterList.hpp>
#include <Stratimikos_MueLuHelpers.hpp>

#include "solve/stratimikos_registration.hpp"

// The library of MueLu has it; to make it anew takes a quarter of a minute.
extern template class Thyra::MueLuPreconditionerFactory<double, int, long long,
                                                        Tpetra::Map<int, long long>::node_type>;

namespace lockstep {

void register_muelu(Stratimikos::DefaultLinearSolverBuilder& builder) {
  Stratimikos::enableMueLu(builder);
}

Teuchos::RCP<const Teuchos::ParameterList> muelu_parameters() {
  return MueLu::MasterList::List();
}

}  // namespace lockstep
