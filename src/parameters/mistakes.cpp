#include "parameters/mistakes.hpp"

#include <algorithm>
#include <ostream>

namespace lockstep {
namespace {

/// A damaged file of many lines must not scroll away its first mistakes.
constexpr std::size_t most_shown = 20;

std::string numbered(const std::vector<std::string>& messages) {
  std::string text = fmt::format("There are {} mistakes:", messages.size());
  const std::size_t shown = std::min(messages.size(), most_shown);
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("\n{}. {}", i + 1, messages[i]);
  if (shown < messages.size())
    text += fmt::format("\n... and {} more.", messages.size() - shown);
  return text;
}

}  // namespace

bool operator==(const Mistake& a, const Mistake& b) {
  return a.messages == b.messages;
}

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) {
  return out << fmt::format("{}", fmt::join(mistake.messages, " "));
}

void check_readable(const ParameterEntry& entry) {
  if (!entry.isType<Mistake>())
    return;
  Mistakes mistakes;
  for (const std::string& message : Teuchos::getValue<Mistake>(entry).messages)
    mistakes.add(message);
  mistakes.throw_all();
}

InputErrors::InputErrors(const std::vector<std::string>& messages)
    : InputError(numbered(messages)), messages_(messages) {}

void Mistakes::add(const std::string& message, const std::string& key) {
  if (keys_.insert(key).second)
    messages_.push_back(message);
}

void Mistakes::throw_all() const {
  if (messages_.size() == 1)
    throw InputError(messages_.front());
  if (!messages_.empty())
    throw InputErrors(messages_);
}

}  // namespace lockstep
