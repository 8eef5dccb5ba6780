#include "strategies/register_strategies.hpp"

#include "strategies/block_elimination/block_elimination.hpp"
#include "strategies/direct/direct.hpp"
#include "strategies/paper/paper.hpp"
#include "strategies/pressure_schur/pressure_schur.hpp"
#include "strategies/schur_cg/schur_cg.hpp"
#include "strategies/stratimikos/stratimikos_strategy.hpp"

namespace lockstep {

void register_strategies(StrategyRegistry& registry) {
  add_strategy<SchurCg>(
      registry, "schur-cg",
      "Conjugate gradients on A + B C^-1 B^T with multigrid for A: the fastest while C is "
      "cheap to invert");
  add_strategy<StratimikosStrategy>(
      registry, "stratimikos",
      "Belos' solvers with Teko's block preconditioners, as a Stratimikos list says");
  add_strategy<Paper>(registry, "paper",
                      "The paper's MINRES with incomplete Cholesky of A and the inverse of C");
  add_strategy<PressureSchur>(
      registry, "pressure-schur",
      "MINRES with diag((A + B C^-1 B^T)^-1, C^-1): iterations independent of density");
  add_strategy<BlockElimination>(
      registry, "block-elimination",
      "The assembled Schur complement of Section 6.1, O(n^4): as a baseline");
  add_strategy<Direct>(registry, "direct",
                       "Sparse factorisation gathered on one rank: for small systems");
}

}  // namespace lockstep
