#include "studies/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// Children that run now, for the signal handler; 0: a free place.
std::array<std::atomic<pid_t>, 64> children{};

extern "C" void forward_signal(int signal) {
  for (const std::atomic<pid_t>& child : children) {
    if (child > 0)
      kill(child, signal);
  }
}

/// Lists a child while it lives; one too many is not forwarded to.
class ListedChild {
 public:
  explicit ListedChild(pid_t child) {
    for (std::atomic<pid_t>& place : children) {
      pid_t nobody = 0;
      if (place.compare_exchange_strong(nobody, child)) {
        place_ = &place;
        break;
      }
    }
  }
  ~ListedChild() {
    if (place_ != nullptr)
      *place_ = 0;
  }
  ListedChild(const ListedChild&) = delete;
  ListedChild& operator=(const ListedChild&) = delete;

 private:
  std::atomic<pid_t>* place_ = nullptr;
};

/// Redirections of a child; owns the object of the system.
class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void write_to(int descriptor, const std::string& file) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, file.c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0644);
  }
  void read_nothing() {
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

std::vector<std::string> child_environment() {
  std::vector<std::string> environment;
  for (char** entry = environ; *entry != nullptr; ++entry)
    environment.emplace_back(*entry);
  for (const char* extra : {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                            "OMPI_MCA_rmaps_base_oversubscribe=1", "OMP_NUM_THREADS=1"}) {
    environment.emplace_back(extra);
  }
  return environment;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts)
    result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

}  // namespace

ChildResult run_child(const std::vector<std::string>& command, const std::string& output_file,
                      const std::string& error_file) {
  using Clock = std::chrono::steady_clock;
  FileActions actions;
  actions.read_nothing();
  actions.write_to(STDOUT_FILENO, output_file);
  actions.write_to(STDERR_FILENO, error_file);
  std::vector<std::string> arguments = command, environment = child_environment();
  pid_t child = 0;
  const auto start = Clock::now();
  const int failure = posix_spawnp(&child, arguments.front().c_str(), actions.get(), nullptr,
                                   pointers(arguments).data(), pointers(environment).data());
  check_output(failure == 0, "Cannot start '{}': {}.", command.front(), std::strerror(failure));
  const ListedChild listed(child);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    check_output(errno == EINTR, "Lost '{}' while waiting for it: {}.", command.front(),
                 std::strerror(errno));
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), seconds};
}

void forward_signals_to_children() {
  struct sigaction action = {};
  action.sa_handler = forward_signal;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

}  // namespace lockstep
