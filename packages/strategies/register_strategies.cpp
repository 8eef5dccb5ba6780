#include "strategies/register_strategies.hpp"

#include "strategies/direct/direct.hpp"
#include "strategies/paper/paper.hpp"
#include "strategies/schur_cg/schur_cg.hpp"

namespace lockstep {

namespace {

template <typename Strategy>
void add(StrategyRegistry& registry, const std::string& name, const std::string& documentation) {
  registry.add(name, documentation, &Strategy::valid_parameters,
               [](const ParameterList& list) { return std::make_unique<Strategy>(list); });
}

}  // namespace

void register_strategies(StrategyRegistry& registry) {
  add<SchurCg>(registry, "schur-cg",
               "Conjugate gradients on A + B C^-1 B^T with multigrid for A: the fastest while C is "
               "cheap to invert");
  add<Paper>(registry, "paper",
             "The paper's MINRES with incomplete Cholesky of A and the inverse of C");
  add<Direct>(registry, "direct", "Sparse factorisation gathered on one rank: for small systems");
}

}  // namespace lockstep
