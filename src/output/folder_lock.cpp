#include "output/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "base/errors.hpp"

namespace lockstep {

std::unique_ptr<FolderLock> FolderLock::take(const std::string& folder, double seconds) {
  using Clock = std::chrono::steady_clock;
  const std::string file = folder + "/lock";
  // The descriptor stays open on exec, so that children share the lock.
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, 0666);
  const int reason = descriptor < 0 ? errno : 0;
  check_output(descriptor >= 0, "Cannot write '{}': {}.", file, std::strerror(reason));
  std::unique_ptr<FolderLock> lock(new FolderLock(descriptor));
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    const int failure = errno;
    if (failure == ENOSYS || failure == ENOLCK || failure == EOPNOTSUPP)
      break;
    check_output(failure == EWOULDBLOCK || failure == EINTR, "Cannot lock '{}': {}.", file,
                 std::strerror(failure));
    if (Clock::now() >= end)
      return nullptr;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return lock;
}

FolderLock::~FolderLock() {
  close(descriptor_);
}

}  // namespace lockstep
