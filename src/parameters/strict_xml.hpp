#pragma once
#include <string>

#include "base/communicator.hpp"
#include "parameters/source.hpp"

namespace lockstep {

/// Reads a Teuchos-style XML parameter list strictly. Collective: rank 0 reads the file, every rank
/// parses the same bytes, so all ranks return the same document or throw the same InputError with
/// file and line: malformed XML, elements, attributes or types that do not exist, values that are
/// not entirely of their type, nan and inf, names given twice in one list, text between elements.
Document read_xml(const std::string& file, const Communicator& comm);

/// The same from memory, on this rank alone; `name` stands for the file in messages.
Document read_xml_string(const std::string& text, const std::string& name);

}  // namespace lockstep
