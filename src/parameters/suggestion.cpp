#include "parameters/suggestion.hpp"

#include <algorithm>
#include <cctype>

namespace lockstep {

int edit_distance(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  const int n = static_cast<int>(b.size());
  std::vector<int> two_above(n + 1), above(n + 1), row(n + 1);
  for (int j = 0; j <= n; ++j)
    row[j] = j;
  for (int i = 1; i <= static_cast<int>(a.size()); ++i) {
    std::swap(two_above, above);
    std::swap(above, row);
    row[0] = i;
    for (int j = 1; j <= n; ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped)
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[n];
}

std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates) {
  std::string nearest;
  const int length = static_cast<int>(word.size());
  int smallest = std::min(std::max(2, length / 3), length - 1) + 1;
  for (const std::string& candidate : candidates) {
    const int distance = edit_distance(word, candidate);
    if (distance < smallest) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace lockstep
