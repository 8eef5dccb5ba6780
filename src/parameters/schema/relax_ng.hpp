#pragma once
#include <string>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// RELAX NG (XML syntax) of scenes in XML, for editors and validators: what `json_schema` says of
/// those in YAML. It does not see names that are given twice, nor bounds of the numbers in arrays.
std::string relax_ng(const ParameterList& plane, const ParameterList& space);

}  // namespace lockstep
