#pragma once
#include <string>
#include <vector>

namespace lockstep {

/// Number of single-character insertions, deletions, replacements and swaps of neighbours that turn
/// one word into the other, upper and lower case being the same.
int edit_distance(const std::string& a, const std::string& b);

/// The candidate nearest to `word`, or an empty string if none is near enough to be a misspelling.
std::string nearest_name(const std::string& word, const std::vector<std::string>& candidates);

/// True if the word is one of these.
bool contains(const std::vector<std::string>& words, const std::string& word);

}  // namespace lockstep
