#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/formula.hpp"
#include "parameters/source.hpp"

/// Files of parameters: scenes, studies, solver files. One whose name ends in ".yaml" or ".yml" is
/// YAML, any other XML.
namespace lockstep {

/// Reads a parameter file strictly, see `read_xml_string` and `read_yaml_string`. Collective: rank
/// 0 reads the file, every rank parses the same bytes, so all ranks return the same document or
/// throw the same InputError.
Document read_parameters(const std::string& file, const Communicator& comm,
                         FormulaPolicy formulas = FormulaPolicy::refused);

/// Reads what `file` holds from memory, on this rank alone.
Document read_parameters_text(const std::string& text, const std::string& file,
                              FormulaPolicy formulas = FormulaPolicy::refused);

/// "yaml" or "xml", as the name of the file says.
std::string parameter_format(const std::string& file);

}  // namespace lockstep
