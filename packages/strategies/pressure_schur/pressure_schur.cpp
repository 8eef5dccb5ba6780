#include "strategies/pressure_schur/pressure_schur.hpp"

#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/action_operator.hpp"
#include "linear/symmetry_check.hpp"
#include "strategies/common/assembled_schur.hpp"
#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_preconditioner.hpp"
#include "strategies/common/solid_schur.hpp"

namespace lockstep {

ParameterList PressureSchur::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_minres(list, "Lockstep MINRES");
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A, which is extended to one "
                           "of A + B C^-1 B^T. Default: Automatic.");
  declare_solid_inverse(list);
  declare_positive(list, "Largest Solid", 60,
                   "Without multigrid: with at most so many solid unknowns the inverse of A is "
                   "extended by Woodbury's formula, with more A + B diag(C)^-1 B^T is assembled");
  return list;
}

PressureSchur::PressureSchur(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()),
                      pressure_inverse_list(given, "Automatic")),
      pressure_list_(pressure_inverse_list(given, "Automatic")),
      solid_list_(solid_inverse_list(given)) {
  const ParameterList list = with_defaults(given, valid_parameters());
  minres_ = minres_kind(list);
  largest_solid_ = list.get<int>("Largest Solid");
}

RCP<const LinearOperator> PressureSchur::schur_inverse(const BlockSystem& system) {
  if (layout() != nullptr) {
    deflation_ = Deflation::make(system, *layout());
    if (!deflation_)
      return pressure_inverse();
    return action_operator(layout()->map(), [this](const Vector& r, Vector& z) {
      deflation_->apply_balanced(*pressure_inverse(), r, z);
    });
  }
  if (system.solid_block->domain()->dim() <= largest_solid_)
    return SolidSchur::make(system, pressure_inverse(), largest_solid_, name(),
                            SolidSchur::Keep::columns)
        ->woodbury();
  BlockSystem schur = system;
  schur.pressure_block = as_operator(schur_with_diagonal(system));
  schur.pressure_null_space = system.null_space;
  return lockstep::pressure_inverse(schur, pressure_list_);
}

void PressureSchur::build(const BlockSystem& system, bool, bool solid_changed) {
  if (!solid_changed)
    return;
  solid_preconditioner_ =
      solid_preconditioner(system, solid_list_, solid_inverse(), check_symmetry());
  schur_inverse_ = schur_inverse(system);
  if (check_symmetry())
    check_symmetric_positive(*schur_inverse_, "Schur complement of the " + system.name,
                             symmetry_tolerance());
}

int PressureSchur::correct(const BlockSystem& system, const CorrectionRequest& request,
                           Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return solve_by_minres(minres_, system, *request.residual,
                         block_krylov(request, Presumes::symmetry), schur_inverse_,
                         solid_preconditioner_, correction);
}

}  // namespace lockstep
