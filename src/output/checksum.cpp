#include "output/checksum.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "output/exchange.hpp"

namespace lockstep {

namespace {

const std::string line_begin = "\nLockstep CRC-32 ";

std::string checksum_line(std::uint32_t checksum, GlobalIndex n_bytes) {
  return fmt::format("{}{:08x} of {:020} bytes\n", line_begin, checksum, n_bytes);
}

/// A file open for reading, and why something went wrong with it.
class InputBytes {
 public:
  explicit InputBytes(const std::string& path)
      : descriptor_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
    struct stat status {};
    if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) {
      failure_ = std::strerror(errno);
    } else {
      size_ = status.st_size;
    }
  }
  ~InputBytes() {
    if (descriptor_ >= 0)
      close(descriptor_);
  }
  InputBytes(const InputBytes&) = delete;
  InputBytes& operator=(const InputBytes&) = delete;

  GlobalIndex size() const { return size_; }
  const std::string& failure() const { return failure_; }

  /// Fewer bytes than asked for only after a failure.
  std::vector<char> read(GlobalIndex begin, GlobalIndex end) {
    std::vector<char> bytes(static_cast<std::size_t>(std::max<GlobalIndex>(end - begin, 0)));
    std::size_t done = 0;
    while (done < bytes.size() && failure_.empty()) {
      const ssize_t n = pread(descriptor_, bytes.data() + done, bytes.size() - done,
                              static_cast<off_t>(begin) + static_cast<off_t>(done));
      if (n == 0)
        failure_ = "it became shorter while it was read";
      if (n < 0 && errno != EINTR)
        failure_ = std::strerror(errno);
      if (n > 0)
        done += static_cast<std::size_t>(n);
    }
    bytes.resize(done);
    return bytes;
  }

 private:
  int descriptor_;
  GlobalIndex size_ = 0;
  std::string failure_;
};

/// CRC-32 of the first n bytes; every rank reads its part of them.
std::uint32_t checksum_together(const Communicator& comm, InputBytes& file, GlobalIndex n) {
  constexpr GlobalIndex piece = 1 << 20;
  const GlobalIndex begin = first_of_rank(n, comm->getRank(), comm->getSize());
  const GlobalIndex end = first_of_rank(n, comm->getRank() + 1, comm->getSize());
  uLong mine = crc32(0, nullptr, 0);
  for (GlobalIndex at = begin; at < end && file.failure().empty(); at += piece) {
    const std::vector<char> bytes = file.read(at, std::min(at + piece, end));
    mine =
        crc32(mine, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  }
  const std::vector<GlobalIndex> parts =
      gather_all(comm, std::vector<GlobalIndex>{static_cast<GlobalIndex>(mine), end - begin});
  uLong all = crc32(0, nullptr, 0);
  for (std::size_t i = 0; i < parts.size(); i += 2)
    all = crc32_combine(all, static_cast<uLong>(parts[i]), static_cast<z_off_t>(parts[i + 1]));
  return static_cast<std::uint32_t>(all);
}

void fail_together(const Communicator& comm, const std::string& path, const std::string& failure) {
  throw_on_all(comm, failure.empty() ? "" : fmt::format("Cannot read '{}': {}.", path, failure),
               static_cast<int>(ExitCode::output_failed));
}

}  // namespace

std::uint32_t checksum_of(const std::string& text) {
  return static_cast<std::uint32_t>(
      crc32_z(crc32(0, nullptr, 0), reinterpret_cast<const Bytef*>(text.data()), text.size()));
}

void append_checksum(const Communicator& comm, const std::string& path) {
  InputBytes file(path);
  fail_together(comm, path, file.failure());
  comm->barrier();  // nobody measures a file that has grown already
  const std::uint32_t checksum = checksum_together(comm, file, file.size());
  fail_together(comm, path, file.failure());
  std::string failure;
  if (is_root(comm)) {
    const int end = open(path.c_str(), O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC);
    int error = end < 0 ? errno : write_fully(end, checksum_line(checksum, file.size()));
    if (end >= 0 && close(end) != 0 && error == 0)
      error = errno;
    if (error != 0)
      failure = fmt::format("Cannot write '{}': {}.", path, std::strerror(error));
  }
  throw_on_all(comm, failure, static_cast<int>(ExitCode::output_failed));
}

ChecksumState check_checksum(const Communicator& comm, const std::string& path) {
  InputBytes file(path);
  fail_together(comm, path, file.failure());
  const auto length = static_cast<GlobalIndex>(checksum_line(0, 0).size());
  const GlobalIndex n = file.size() - length;
  const std::vector<char> bytes = n < 0 ? std::vector<char>() : file.read(n, file.size());
  fail_together(comm, path, file.failure());
  const std::string line(bytes.begin(), bytes.end());
  if (line.compare(0, line_begin.size(), line_begin) != 0)
    return ChecksumState::absent;
  const std::string expected = checksum_line(checksum_together(comm, file, n), n);
  fail_together(comm, path, file.failure());
  return line == expected ? ChecksumState::intact : ChecksumState::broken;
}

}  // namespace lockstep
