#include <MueLu_MasterList.hpp>
#include <Stratimikos_MueLuHelpers.hpp>

#include "solve/stratimikos_registration.hpp"

namespace lockstep {

void register_muelu(Stratimikos::DefaultLinearSolverBuilder& builder) {
  Stratimikos::enableMueLu(builder);
}

Teuchos::RCP<const Teuchos::ParameterList> muelu_parameters() {
  return MueLu::MasterList::List();
}

}  // namespace lockstep
