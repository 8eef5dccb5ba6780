#include "strategies/direct/direct.hpp"

#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "solve/gathered_direct.hpp"

namespace lockstep {

namespace {
/// Larger systems are refused, for the factorisation lives on one rank, whose memory it would fill.
/// Chosen, not varied by a page.
constexpr int most_unknowns = 300000;
}  // namespace

ParameterList Direct::valid_parameters() {
  return common_strategy_parameters();
}

Direct::Direct(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters())) {}

void Direct::build(const BlockSystem& system, bool geometry_changed, bool) {
  const auto n_pressure = system.pressure_block()->domain()->dim();
  check_solve(n_pressure <= most_unknowns,
              "The strategy direct refuses the {}: its {} pressure unknowns are more than "
              "{}. Choose an iterative strategy.",
              system.name, n_pressure, most_unknowns);
  if (geometry_changed)
    factors_ = {};
  Factors& factors = factors_[system.has_solid()];
  factors.merged = merge(system);
  factors.inverse = gathered_direct(factors.merged.matrix, system.name);
}

int Direct::correct(const BlockSystem& system, const CorrectionRequest& request,
                    Vector& correction) {
  BlockVector rhs, solution;
  rhs.pressure = rcp(new Vector(*request.residual, Teuchos::Copy));
  solution.pressure = make_vector(correction.getMap());
  if (system.has_solid()) {
    rhs.solid = make_vector(system.coupling_transposed()->getRangeMap());
    solution.solid = make_vector(rhs.solid->getMap());
  }
  const auto& [merged, inverse] = factors_[system.has_solid()];
  Vector merged_solution(merged.matrix->getRowMap());
  apply(*inverse, *to_merged(merged, rhs), merged_solution);
  from_merged(merged, merged_solution, solution);
  correction.update(1, *solution.pressure, 0);
  return 1;
}

}  // namespace lockstep
