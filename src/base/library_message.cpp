#include "base/library_message.hpp"

#include <cctype>

#include "base/shortened.hpp"

namespace lockstep {

std::string library_message(const std::exception& error) {
  constexpr std::size_t most = 300;
  std::string text = error.what();
  // Trilinos: file, "Throw number = 1", the condition, then the message.
  const std::size_t condition = text.rfind("Throw test that evaluated to true");
  const std::size_t message =
      condition == std::string::npos ? condition : text.find("\n\n", condition);
  if (message != std::string::npos && text.find_first_not_of("\n ", message) != std::string::npos)
    text.erase(0, message);
  std::string line;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!blank)
      line += c;
    else if (!line.empty() && line.back() != ' ')
      line += ' ';
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.'))
    line.pop_back();
  return line.empty() ? "it gives no reason" : shortened(line, most);
}

}  // namespace lockstep
