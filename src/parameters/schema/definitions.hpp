#pragma once
#include <string>
#include <unordered_map>

namespace lockstep {

/// Names for the parts of a schema, so that what is alike stands in it once.
class Definitions {
 public:
  /// The name of a part with this text, made from `hint` if it is new.
  const std::string& name_of(const std::string& hint, const std::string& text);
  /// True if the last call of `name_of` made a new name.
  bool is_new() const { return is_new_; }

 private:
  std::unordered_map<std::string, std::string> names_;  ///< by text
  std::unordered_map<std::string, int> uses_;           ///< number of each hint's names
  bool is_new_ = false;
};

}  // namespace lockstep
