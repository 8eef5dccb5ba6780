#pragma once
#include <iosfwd>
#include <set>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"

/// Mistakes of a parameter file are told all at once, so that one run is enough to see them.
namespace lockstep {

/// Messages in a list in place of a value that cannot be read or made, until `validate` tells of
/// it. It is there only in lists that were read with FormulaPolicy::kept.
struct Mistake {
  std::vector<std::string> messages;
};
bool operator==(const Mistake& a, const Mistake& b);
std::ostream& operator<<(std::ostream& out, const Mistake& mistake);
/// Throws InputError with what is told by an entry that is a `Mistake`.
void check_readable(const ParameterEntry& entry);

/// Several messages thrown as one, each on a line of its own with a number before it.
class InputErrors : public InputError {
 public:
  explicit InputErrors(const std::vector<std::string>& messages);
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  std::vector<std::string> messages_;
};

/// The messages about one file, in the order in which they are found.
class Mistakes {
 public:
  /// Notes a message; only the first of those with one key, as copies of a solid have the mistakes
  /// of the original.
  void add(const std::string& message, const std::string& key);
  void add(const std::string& message) { add(message, message); }
  /// Calls f and notes what it throws as InputError. Without a key each message is its own.
  template <typename Function>
  void collect(const Function& f, const std::string& key = "");
  bool empty() const { return messages_.empty(); }
  const std::vector<std::string>& messages() const { return messages_; }
  /// Throws InputErrors, or InputError if there is one alone; returns if there is none.
  void throw_all() const;

 private:
  std::vector<std::string> messages_;
  std::set<std::string> keys_;
};

template <typename Function>
void Mistakes::collect(const Function& f, const std::string& key) {
  try {
    f();
  } catch (const InputErrors& errors) {
    for (const std::string& message : errors.messages())
      add(message);
  } catch (const InputError& error) {
    add(error.what(), key.empty() ? error.what() : key);
  }
}

/// Calls f; what it throws as InputError is put into the list as a `Mistake` of that name.
template <typename Function>
void keep_mistakes(ParameterList& list, const std::string& name, const Function& f) {
  Mistakes mistakes;
  mistakes.collect(f);
  if (!mistakes.empty())
    list.setEntry(name, ParameterEntry(Mistake{mistakes.messages()}));
}

}  // namespace lockstep
