#pragma once
#include <string>

#include "parameters/source.hpp"

namespace lockstep {

/// Reads a parameter file in YAML strictly, on this rank alone; `name` stands for the file in
/// messages. Lists are maps, arrays are sequences; values stay `Untyped` until `assign_types`.
/// Throws InputError with the file and the lines of all mistakes: malformed YAML, names given
/// twice in one list or that are no scalars, names without a value, arrays in arrays, and of YAML
/// what no parameter file needs: anchors, aliases, merges, tags, a second document.
Document read_yaml_string(const std::string& text, const std::string& name);

}  // namespace lockstep
