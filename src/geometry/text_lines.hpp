#pragma once
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "base/shortened.hpp"

namespace lockstep {

/// Throws InputError if a mesh file has so many vertices or simplices that a body of them would
/// take all memory; `where`: of the file.
inline void check_mesh_entries(const std::string& where, std::size_t n) {
  constexpr std::size_t most = 10000000;
  check_input(n <= most,
              "{}: the mesh has {} vertices or elements, or more; at most {} are accepted: make it "
              "coarser.",
              where, n, most);
}

/// The lines of a text file as words, with the line number for messages. Internal to the readers.
class TextLines {
 public:
  explicit TextLines(const std::string& file) : file_(file), stream_(file) {
    std::error_code error;  // a file that is not there has its own message
    size_ = std::filesystem::file_size(file, error);
  }

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

  int line() const { return number_; }

  /// Throws InputError if the file announces more entries than it has bytes, or than are accepted.
  void check_count(long n) const {
    check_input(n >= 0, "{}: a count is negative: {}.", where(), n);
    check_input(static_cast<std::uintmax_t>(n) <= size_,
                "{}: {} entries are announced, but the file has {} bytes; it is damaged.", where(),
                n, size_);
    check_mesh_entries(where(), static_cast<std::size_t>(n));
  }

  /// A finite number in decimal notation.
  double number(const std::string& word) const {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    const bool whole = !word.empty() && end == word.c_str() + word.size();
    const bool decimal = word.find_first_of("xXpP") == std::string::npos;
    check_input(whole && decimal, "{}: expected a number, but found '{}'.", where(),
                shortened(word));
    check_input(std::isfinite(value), "{}: expected a finite number, but found '{}'.", where(),
                shortened(word));
    return value;
  }
  long integer(const std::string& word) const { return integer(word, word); }
  /// Reads an integer from a part of a word; the message shows all of the word.
  long integer(const std::string& part, const std::string& word) const {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(part.c_str(), &end, 10);
    check_input(!part.empty() && end == part.c_str() + part.size(),
                "{}: expected a whole number, but found '{}'.", where(), shortened(word));
    check_input(errno == 0 && std::abs(value) <= std::numeric_limits<int>::max(),
                "{}: the number '{}' is too large.", where(), shortened(word));
    return value;
  }

 private:
  std::string file_;
  std::ifstream stream_;
  std::uintmax_t size_;  ///< [bytes]
  int number_ = 0;
};

}  // namespace lockstep
