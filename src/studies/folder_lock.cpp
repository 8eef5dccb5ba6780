#include "studies/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/errors.hpp"

namespace lockstep {

FolderLock::FolderLock(const std::string& folder, double seconds) {
  using Clock = std::chrono::steady_clock;
  const std::string file = folder + "/lock";
  // Not closed on exec: children share the lock.
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, 0666);
  const int reason = descriptor_ < 0 ? errno : 0;
  check_output(descriptor_ >= 0, "Cannot write '{}': {}.", file, std::strerror(reason));
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      continue;
    }
    const int failure = errno;
    close(descriptor_);
    throw OutputError(
        failure == EWOULDBLOCK
            ? fmt::format(
                  "Another study, or a run that it has left behind, works in '{}': wait for it, "
                  "end it or choose another --output.",
                  folder)
            : fmt::format("Cannot lock '{}': {}.", file, std::strerror(failure)));
  }
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

}  // namespace lockstep
