#pragma once
#include <string>

#include "parameters/parameter_rule.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Holds `given` against `valid` and fills in what it leaves out: defaults, nested lists,
/// docstrings. Throws InputError with the place and the path of all mistakes together: an unknown
/// name (with a suggestion and all names valid there), a wrong type, a value that cannot be read,
/// out of bounds or not among the choices, a wrong number of components, a missing required
/// parameter. `path` is where `given` sits in the document; `constants` are those of its scene, for
/// messages about formulas. Not collective; the same lists give the same result on every rank.
void validate(ParameterList& given, const ParameterList& valid, const Source& source,
              const std::string& path = "", const Variables& constants = {});
void validate(Document& document, const ParameterList& valid);

/// The message for `name`, which `valid` does not have: what became of a name that once was there,
/// else a suggestion and the list of names.
std::string unknown_name(const std::string& place, const std::string& path, const std::string& name,
                         const ParameterList& valid);

/// The schema of the sublist `given` found under a rule of form typed or named_typed. Throws
/// InputError if its "Type" is missing or unknown.
const ParameterList& chosen_schema(const ListRule& rule, const ParameterList& given,
                                   const Source& source, const std::string& path);

}  // namespace lockstep
