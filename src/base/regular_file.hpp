#pragma once
#include <string>

/// Files that are input. A pipe or a device would let the program wait for ever, so only plain
/// files (and links to them) are read. None of these functions is collective.
namespace lockstep {

/// Reason why `path` cannot be read as a plain file, "it is a pipe" or "No such file or directory";
/// empty if it can. Never waits.
std::string refusal_to_read(const std::string& path);

/// Reads all bytes of a plain file; if it cannot be read, nothing, and `failure` gets the reason.
std::string read_regular_file(const std::string& path, std::string& failure);

}  // namespace lockstep
