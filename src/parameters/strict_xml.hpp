#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Treatment of a number that is written as a formula in brackets, value="[2*R]": refused as a
/// mistake, or kept for `evaluate_formulas`.
enum class FormulaPolicy { refused, kept };

/// Reads a Teuchos-style XML parameter list strictly. Collective: rank 0 reads the file, every rank
/// parses the same bytes, so all ranks return the same document or throw the same InputError with
/// the file and the lines of all mistakes: malformed XML, elements, attributes or types that do not
/// exist, values that are not entirely of their type, nan and inf, names given twice in one list,
/// text between elements. With FormulaPolicy::kept values that are wrong stay in the list as
/// `Mistake`s, so that `validate` can tell of them together with its own.
Document read_xml(const std::string& file, const Communicator& comm,
                  FormulaPolicy formulas = FormulaPolicy::refused);

/// Reads a document from memory, on this rank alone; `name` stands for the file in messages.
Document read_xml_string(const std::string& text, const std::string& name,
                         FormulaPolicy formulas = FormulaPolicy::refused);

}  // namespace lockstep
