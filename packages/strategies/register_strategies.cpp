#include "strategies/register_strategies.hpp"

#include "strategies/block_elimination/block_elimination.hpp"
#include "strategies/block_lu/block_lu.hpp"
#include "strategies/bramble_pasciak/bramble_pasciak.hpp"
#include "strategies/direct/direct.hpp"
#include "strategies/gauss_seidel/gauss_seidel.hpp"
#include "strategies/paper/paper.hpp"
#include "strategies/pressure_schur/pressure_schur.hpp"
#include "strategies/schur_cg/schur_cg.hpp"
#include "strategies/simple/simple.hpp"
#include "strategies/solid_schur/minres_solid_schur.hpp"
#include "strategies/uzawa/uzawa.hpp"

namespace lockstep {

void register_strategies(StrategyRegistry& registry) {
  add_strategy<SchurCg>(
      registry, "schur-cg",
      "Conjugate gradients on A + B C^-1 B^T with multigrid for A: the fastest while C is "
      "cheap to invert");
  add_strategy<Paper>(registry, "paper",
                      "The paper's MINRES with incomplete Cholesky of A and the inverse of C");
  add_strategy<PressureSchur>(
      registry, "pressure-schur",
      "MINRES with diag((A + B C^-1 B^T)^-1, C^-1): iterations independent of density");
  add_strategy<MinresSolidSchur>(registry, "solid-schur",
                                 "MINRES with diag(A^-1, (C + B^T A^-1 B)^-1): a few rigid bodies");
  add_strategy<BlockLu>(registry, "block-lu",
                        "Flexible GMRES with Teko's block LU factorisation: a few rigid bodies");
  add_strategy<GaussSeidel>(registry, "gauss-seidel",
                            "Flexible GMRES with Teko's block Gauss-Seidel");
  add_strategy<Simple>(registry, "simple", "Flexible GMRES with Teko's SIMPLE");
  add_strategy<BramblePasciak>(
      registry, "bramble-pasciak",
      "Conjugate gradients on the indefinite system in an inner product of its own");
  add_strategy<Uzawa>(registry, "uzawa",
                      "The partitioned iteration, as a control: heavy solids only");
  add_strategy<BlockElimination>(
      registry, "block-elimination",
      "The assembled Schur complement of Section 6.1, O(n^4): as a baseline");
  add_strategy<Direct>(registry, "direct",
                       "Sparse factorisation gathered on one rank: for small systems");
}

}  // namespace lockstep
