#include "stepping/sound_lists.hpp"

namespace lockstep {

namespace {

/// More names are counted, not told.
constexpr std::size_t most_names = 5;

std::string without(std::string text, const std::string& name) {
  for (std::size_t at = text.find(name); !name.empty() && at != std::string::npos;
       at = text.find(name, at))
    text.erase(at, name.size());
  return text;
}

}  // namespace

void ListMistakes::add(const std::string& name, const std::vector<std::string>& messages) {
  for (const std::string& message : messages) {
    const std::string key = without(message, name);
    const auto same = std::find_if(found_.begin(), found_.end(),
                                   [&](const Found& one) { return one.key == key; });
    if (same == found_.end())
      found_.push_back({key, message, {}});
    else
      same->others.push_back(name);
  }
}

void ListMistakes::tell(Mistakes& mistakes) const {
  for (const Found& one : found_) {
    std::string text = one.message;
    const std::size_t n = one.others.size(), shown = std::min(n, most_names);
    for (std::size_t i = 0; i < shown; ++i)
      text += fmt::format("{}\"{}\"", i == 0 ? " The same holds for " : ", ", one.others[i]);
    text += n > shown ? fmt::format(" and {} more.", n - shown) : n > 0 ? "." : "";
    mistakes.add(text);
  }
}

}  // namespace lockstep
