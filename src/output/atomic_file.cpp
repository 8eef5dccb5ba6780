#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"

namespace lockstep {

namespace {
[[noreturn]] void fail_writing(const std::string& path, int error) {
  discard_part(path);
  throw OutputError(
      fmt::format("Cannot write '{}': {}. Free some space or choose another --output.", path,
                  std::strerror(error)));
}

/// Makes a rename survive a power failure. File systems that cannot sync a folder are left alone.
void sync_folder_of(const std::string& path) {
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const int folder = open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY);
  if (folder < 0)
    return;
  fsync(folder);
  close(folder);
}
}  // namespace

std::string part_name(const std::string& path) {
  return path + ".part";
}

void discard_part(const std::string& path) noexcept {
  unlink(part_name(path).c_str());
}

int write_fully(int descriptor, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t n = write(descriptor, text.data() + done, text.size() - done);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return errno;
    done += static_cast<std::size_t>(n);
  }
  return 0;
}

void write_file_atomically(const std::string& path, const std::string& text) {
  const int file = open(part_name(path).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (file < 0)
    fail_writing(path, errno);
  const int error = write_fully(file, text);
  if (close(file) != 0 || error != 0)
    fail_writing(path, error != 0 ? error : errno);
  commit_part(path);
}

void commit_part(const std::string& path) {
  const std::string part = part_name(path);
  const int file = open(part.c_str(), O_RDWR);
  if (file < 0)
    fail_writing(path, errno);
  const int error = fsync(file) == 0 ? 0 : errno;
  close(file);
  if (error != 0)
    fail_writing(path, error);
  if (std::rename(part.c_str(), path.c_str()) != 0)
    fail_writing(path, errno);
  sync_folder_of(path);
}

std::string read_whole_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  check_output(file.is_open(), "Cannot read '{}': {}.", path, std::strerror(errno));
  std::ostringstream text;
  text << file.rdbuf();
  check_output(!file.bad(), "Cannot read '{}' to its end.", path);
  return text.str();
}

}  // namespace lockstep
