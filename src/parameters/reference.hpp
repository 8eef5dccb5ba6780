#pragma once
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

/// The parameter reference, generated from a valid list; the same list gives the same text.
namespace lockstep {

/// Plain text for the terminal.
std::string reference_text(const ParameterList& valid);
/// For programs: an array of objects, one a list ("path", "documentation", "note") in the order of
/// reference_text, whose "parameters" each have "name", "type", "default", "allowed",
/// "documentation".
std::string reference_json(const ParameterList& valid);
/// Paths of all parameters, lists and types that have an empty docstring.
std::vector<std::string> undocumented(const ParameterList& valid);

}  // namespace lockstep
