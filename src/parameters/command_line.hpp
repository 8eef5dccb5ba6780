#pragma once
#include <string>

#include "parameters/source.hpp"

namespace lockstep {

/// Applies `--set "List/Sub list/Name=value"` to a document read but not yet validated. The type of
/// the value comes from `valid`; in a list passed on unchecked from the entry that is there, or
/// from the text. Numbers may be formulas in brackets of the document's constants. Throws
/// InputError for unknown names (with a suggestion) and values not of that type; bounds and choices
/// are left to `validate`, which then names the command line as the place.
void set_from_command_line(Document& document, const std::string& assignment,
                           const ParameterList& valid);

/// Sets an entry without a schema: the type comes from the entry that is there, or from the text.
/// Formulas are kept, as constants are not known yet.
void set_unchecked(Document& document, const std::string& assignment);

/// The number that an option was given, at least 1. Throws InputError.
long long parse_count(const std::string& option, const std::string& text);

}  // namespace lockstep
