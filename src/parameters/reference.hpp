#pragma once
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"

/// The parameter reference, generated from a valid list; the same list gives the same text.
namespace lockstep {

/// Plain text for the terminal.
std::string reference_text(const ParameterList& valid);
/// A Markdown page: one section a list with a table of name, type, default, allowed values,
/// meaning.
std::string reference_markdown(const std::string& title, const ParameterList& valid);
/// Paths of all parameters, lists and types that have an empty docstring.
std::vector<std::string> undocumented(const ParameterList& valid);

}  // namespace lockstep
