#pragma once
#include <string>
#include <vector>

namespace lockstep {

/// As it stands in a line of a table: in quotes if it holds a separator, a quote or a #, after RFC
/// 4180. Text without line breaks only.
std::string csv_field(const std::string& text);

/// The fields of a line, without their quotes.
std::vector<std::string> csv_fields(const std::string& line);

}  // namespace lockstep
