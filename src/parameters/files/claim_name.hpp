#pragma once
#include <string>

#include "parameters/source.hpp"

namespace lockstep {

/// Functions that walk through lists recurse into nested ones, so that their depth is bounded.
constexpr std::size_t most_nested_lists = 100;

/// Notes where `name` of `list`, which stands at `list_path` of the document, is given; returns its
/// path. Throws InputError, a sentence without the place, for one that the list has and for one
/// that is too long for messages, tables and files.
std::string claim_name(Document& document, const ParameterList& list, const std::string& list_path,
                       const std::string& name, const std::string& place);

}  // namespace lockstep
