#include "strategies/block_elimination/block_elimination.hpp"

#include <Tpetra_CrsMatrix.hpp>

#include "base/errors.hpp"
#include "linear/conjugate_gradients.hpp"
#include "strategies/common/assembled_schur.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

ParameterList BlockElimination::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the assembled Schur complement, and of A where "
                           "there is no solid; not Multigrid. Default: Incomplete Cholesky.");
  return list;
}

BlockElimination::BlockElimination(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()), incomplete_cholesky_list(given)),
      list_(incomplete_cholesky_list(given)) {
  const auto& type = list_.get<std::string>("Type");
  check_input(
      type != "Multigrid" && type != "Automatic",
      "\"Pressure Inverse\": block-elimination assembles its matrix, which type \"{}\" does "
      "not take. Choose Incomplete Cholesky, Ifpack2 or MueLu.",
      type);
}

void BlockElimination::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  schur_ = assembled_schur(system);
  BlockSystem eliminated = system;
  eliminated.set_blocks(as_operator(schur_), system.coupling_transposed(), system.solid_block());
  eliminated.pressure_null_space = system.null_space;
  eliminated.name = "Schur complement of the " + system.name;
  schur_inverse_ = lockstep::pressure_inverse(eliminated, list_);
}

long BlockElimination::stored_nonzeros() const {
  return schur_.is_null() ? 0 : static_cast<long>(schur_->getGlobalNumEntries());
}

int BlockElimination::correct(const BlockSystem& system, const CorrectionRequest& request,
                              Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return conjugate_gradients([&](const Vector& x, Vector& y) { schur_->apply(x, y); },
                             [&](const Vector& r, Vector& z) { apply(*schur_inverse_, r, z); },
                             *request.residual, correction,
                             {request.name, request.target, request.maximum_iterations,
                              iteration_null_space(system), request.update_target});
}

}  // namespace lockstep
