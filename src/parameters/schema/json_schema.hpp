#pragma once
#include <string>

#include "parameters/parameter_list.hpp"

namespace lockstep {

/// JSON Schema (draft 7) of scenes in YAML, for editors and validators: names, types, choices,
/// bounds and documentation of `plane` and `space`, the schemas of scenes as they are written in
/// two and three dimensions. It asks for no parameter: an included file may have what is required.
std::string json_schema(const ParameterList& plane, const ParameterList& space);

}  // namespace lockstep
