#pragma once
#include <Teuchos_ParameterList.hpp>
#include <optional>
#include <string>

namespace lockstep {

/// Facts of a Stratimikos list that the strategy must know before Trilinos reads it.
struct SolverFacts {
  std::string inverse;  ///< Teko's "Inverse Type"; empty: no preconditioner
  /// The inverse of A in it; empty: unknown.
  std::string pressure_inverse;
  /// The list of type "Lockstep Multigrid" among the inverses that are used.
  std::optional<Teuchos::ParameterList> multigrid;
  bool wants_schur = false;  ///< one is "Lockstep Schur"
  /// Some factory multiplies blocks with each other, which Teko can do with plain matrices only.
  bool wants_explicit_blocks = false;
};

/// Reads and checks a Stratimikos list (solve/solver_list.hpp checks the names in it). Throws
/// InputError for a solver other than one of Belos, or a preconditioner other than one of Teko.
SolverFacts solver_facts(const Teuchos::ParameterList& list);

}  // namespace lockstep
