#pragma once
#include <string>

#include "parameters/formula.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Reads a Teuchos-style XML parameter list strictly, on this rank alone; `name` stands for the
/// file in messages. Throws InputError with the file and the lines of all mistakes: malformed XML,
/// elements, attributes or types that do not exist, values that are not entirely of their type, nan
/// and inf, names given twice in one list, text between elements. With FormulaPolicy::kept values
/// that are wrong stay in the list as `Mistake`s, so that `validate` can tell of them together with
/// its own.
Document read_xml_string(const std::string& text, const std::string& name,
                         FormulaPolicy formulas = FormulaPolicy::refused);

}  // namespace lockstep
