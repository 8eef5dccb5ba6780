#pragma once
#include <string>

namespace lockstep {

/// Text of a user, shortened for a message: control characters become '?', and of more than `most`
/// characters the first are kept, with "..." after them.
inline std::string shortened(const std::string& text, std::size_t most = 60) {
  std::string result = text.substr(0, most);
  if (text.size() > most) {
    // A character of several bytes is not cut.
    while (!result.empty() && (static_cast<unsigned char>(text[result.size()]) & 0xc0) == 0x80)
      result.pop_back();
    result += "...";
  }
  for (char& c : result) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      c = '?';
  }
  return result;
}

}  // namespace lockstep
