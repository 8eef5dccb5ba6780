#include "strategies/solid_schur/minres_solid_schur.hpp"

#include "strategies/common/pressure_inverse.hpp"
#include "strategies/common/solid_schur.hpp"

namespace lockstep {

ParameterList MinresSolidSchur::valid_parameters() {
  ParameterList list = minres_parameters("Lockstep MINRES");
  declare_pressure_inverse(list,
                           "Approximate inverse of the pressure block A. Default: Automatic.");
  declare_positive(list, "Largest Solid", 300,
                   "Systems of more solid unknowns are refused: A is inverted once for each");
  return list;
}

MinresSolidSchur::MinresSolidSchur(const ParameterList& given)
    : MinresStrategy(with_defaults(given, valid_parameters()),
                     pressure_inverse_list(given, "Automatic")),
      largest_solid_(with_defaults(given, valid_parameters()).get<int>("Largest Solid")) {}

MinresStrategy::Preconditioners MinresSolidSchur::make_preconditioners(const BlockSystem& system) {
  refuse_region_closed_by_solid(system);
  return {pressure_inverse(),
          SolidSchur::make(system, pressure_inverse(), largest_solid_, name())->inverse()};
}

}  // namespace lockstep
