#pragma once
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.hpp"

namespace lockstep {

/// The lines of a text file as words, with the line number for messages. Internal to the readers.
class TextLines {
 public:
  explicit TextLines(const std::string& file) : file_(file), stream_(file) {}

  /// Next line that holds words; what follows '#' is skipped. False at the end of the file.
  bool next(std::vector<std::string>& words) {
    std::string line;
    while (std::getline(stream_, line)) {
      ++number_;
      std::istringstream stream(line.substr(0, line.find('#')));
      words.clear();
      for (std::string word; stream >> word;)
        words.push_back(word);
      if (!words.empty())
        return true;
    }
    return false;
  }

  /// "file, line n", for messages.
  std::string where() const { return fmt::format("{}, line {}", file_, number_); }

  double number(const std::string& word) const {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    check_input(end != word.c_str() && *end == '\0', "{}: expected a number, but found '{}'.",
                where(), word);
    return value;
  }
  long integer(const std::string& word) const {
    char* end = nullptr;
    const long value = std::strtol(word.c_str(), &end, 10);
    check_input(end != word.c_str() && *end == '\0', "{}: expected a whole number, but found '{}'.",
                where(), word);
    return value;
  }

 private:
  std::string file_;
  std::ifstream stream_;
  int number_ = 0;
};

}  // namespace lockstep
