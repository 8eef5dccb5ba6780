#include "base/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lockstep {

namespace {

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode))
    return "it is a folder";
  if (S_ISFIFO(mode))
    return "it is a pipe, not a file";
  return S_ISSOCK(mode) ? "it is a socket, not a file" : "it is a device, not a file";
}

/// A descriptor, or -1 and why not. Without O_NONBLOCK the opening of a pipe would wait.
int open_regular_file(const std::string& path, std::string& failure) {
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || fstat(file, &status) != 0) {
    failure = std::strerror(errno);
  } else if (!S_ISREG(status.st_mode)) {
    failure = kind_of(status.st_mode);
  } else {
    return file;
  }
  if (file >= 0)
    close(file);
  return -1;
}

}  // namespace

std::string refusal_to_read(const std::string& path) {
  std::string failure;
  const int file = open_regular_file(path, failure);
  if (file >= 0)
    close(file);
  return failure;
}

std::string read_regular_file(const std::string& path, std::string& failure) {
  failure.clear();
  const int file = open_regular_file(path, failure);
  if (file < 0)
    return "";
  std::string text;
  char buffer[1 << 16];
  ssize_t n = 0;
  while ((n = read(file, buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR)) {
    if (n > 0)
      text.append(buffer, static_cast<std::size_t>(n));
  }
  if (n < 0) {
    failure = std::strerror(errno);
    text.clear();
  }
  close(file);
  return text;
}

}  // namespace lockstep
