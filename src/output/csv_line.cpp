#include "output/csv_line.hpp"

namespace lockstep {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"#") == std::string::npos)
    return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"')
      result += '"';
    result += c;
  }
  return result + '"';
}

std::vector<std::string> csv_fields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside_quotes = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool is_doubled = inside_quotes && line.compare(i, 2, "\"\"") == 0;
    if (line[i] == '"' && !is_doubled) {
      inside_quotes = !inside_quotes;
    } else if (line[i] == ',' && !inside_quotes) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
      i += is_doubled ? 1 : 0;
    }
  }
  return fields;
}

}  // namespace lockstep
