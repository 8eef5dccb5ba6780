#include "output/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "base/errors.hpp"
#include "base/regular_file.hpp"

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

int write_fully_at(int descriptor, const char* bytes, std::size_t size, long long offset) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = pwrite(descriptor, bytes + done, size - done,
                             static_cast<off_t>(offset) + static_cast<off_t>(done));
    if (n < 0 && errno != EINTR)
      return errno;
    if (n > 0)
      done += static_cast<std::size_t>(n);
  }
  return 0;
}

int open_part(const std::string& path, std::string& failure) {
  const std::string part = part_name(path);
  const auto create = [&part] {
    return open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  };
  int file = create();
  if (file < 0 && errno == EEXIST) {
    struct stat status {};
    if (lstat(part.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
      failure = fmt::format("'{}' is in the way and no plain file; remove it", part);
      return -1;
    }
    unlink(part.c_str());  // left by a run that was killed
    file = create();
  }
  if (file < 0)
    failure = std::strerror(errno);
  return file;
}

void write_file_atomically(const std::string& path, const std::string& text) {
  std::string failure;
  const int file = open_part(path, failure);
  check_output(file >= 0, "Cannot write '{}': {}. Choose another --output.", path, failure);
  const int error = write_fully(file, text);
  if (close(file) != 0 || error != 0)
    fail_writing(path, error != 0 ? error : errno);
  commit_part(path);
}

void commit_part(const std::string& path) {
  const std::string part = part_name(path);
  const int file = open(part.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
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
  std::string failure;
  std::string text = read_regular_file(path, failure);
  check_output(failure.empty(), "Cannot read '{}': {}.", path, failure);
  return text;
}

}  // namespace lockstep
