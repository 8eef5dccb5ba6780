#include "parameters/schema/definitions.hpp"

#include <cctype>

namespace lockstep {

const std::string& Definitions::name_of(const std::string& hint, const std::string& text) {
  const auto [found, is_new] = names_.try_emplace(text);
  is_new_ = is_new;
  if (is_new) {
    std::string name;
    for (const char c : hint)
      name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
    if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0)
      name.insert(0, "of-");
    found->second = name + "." + std::to_string(++uses_[name]);
  }
  return found->second;
}

}  // namespace lockstep
