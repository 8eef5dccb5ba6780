#include "strategies/paper/paper.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/preconditioner.hpp"
#include "linear/symmetry_check.hpp"
#include "linear/thyra_vectors.hpp"
#include "strategies/common/belos_minres.hpp"
#include "strategies/common/pressure_inverse.hpp"

namespace lockstep {

namespace {

/// RILUK(0) of a symmetric matrix is its incomplete Cholesky factorisation without fill.
ParameterList pressure_list_of(const ParameterList& given) {
  ParameterList list = pressure_inverse_list(given, "Ifpack2");
  if (list.get<std::string>("Type") == "Ifpack2" && list.numParams() == 1) {
    list.set("Prec Type", "RILUK");
    list.set("Overlap", 0);
    list.sublist("Ifpack2 Settings").set("fact: iluk level-of-fill", 0);
  }
  return list;
}

ParameterList default_solid_inverse() {
  ParameterList list;
  list.set("Type", "Exact");
  return list;
}

}  // namespace

ParameterList Paper::valid_parameters() {
  ParameterList list = common_strategy_parameters();
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Ifpack2's "
                           "RILUK(0), which is the paper's incomplete Cholesky.");
  declare_inverse(list, "Solid Inverse",
                  "Approximate inverse of the solid block C. Default: Exact.");
  return list;
}

Paper::Paper(const ParameterList& given)
    : RefinedStrategy(with_defaults(given, valid_parameters()), pressure_list_of(given)),
      solid_list_(inverse_list(given, "Solid Inverse", default_solid_inverse())) {}

void Paper::build(const BlockSystem& system, bool, bool solid_changed) {
  const std::string solid_name = "solid block of the " + system.name;
  if (system.has_solid())
    check_no_empty_rank(system, "The strategy paper");
  if (solid_changed) {
    solid_preconditioner_ =
        solid_list_.get<std::string>("Type") == "Exact"
            ? solid_inverse()
            : preconditioner_from_list(system.solid_block, solid_list_, solid_name);
    if (check_symmetry())
      check_symmetric_positive(*solid_preconditioner_, solid_name);
  }
}

int Paper::correct(const BlockSystem& system, const CorrectionRequest& request,
                   Vector& correction) {
  if (!system.has_solid())
    return pressure_cg(system, request, correction);
  return belos_minres(system, *request.residual,
                      {request.name, request.target, request.pressure_scale, request.solid_scale,
                       request.maximum_iterations},
                      pressure_inverse(), solid_preconditioner_, correction);
}

}  // namespace lockstep
