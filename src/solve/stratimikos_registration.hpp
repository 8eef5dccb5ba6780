#pragma once
#include <Teuchos_ParameterList.hpp>

#include "linear/types.hpp"

namespace Stratimikos {
class DefaultLinearSolverBuilder;
}

/// For files that include Stratimikos: one translation unit for each heavy package.
namespace lockstep {

void register_muelu(Stratimikos::DefaultLinearSolverBuilder& builder);
/// Registers Teko, with our factory "SPD Block Diagonal" (strategies/stratimikos/block_inverses.hpp
/// has more). Must come after every other package, whose list Teko copies.
void register_teko(Stratimikos::DefaultLinearSolverBuilder& builder);
/// MueLu's own list of the parameters of its simple interface.
Teuchos::RCP<const Teuchos::ParameterList> muelu_parameters();

/// A builder that knows Ifpack2, MueLu and Teko beside Stratimikos' own packages.
RCP<Stratimikos::DefaultLinearSolverBuilder> make_solver_builder();

}  // namespace lockstep
