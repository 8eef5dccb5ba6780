#include "studies/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
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

std::atomic<int> received{0};

extern "C" void forward_signal(int signal) {
  received = signal;
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

/// Arguments of a child process, made before the fork: nothing may be allocated after it.
struct ChildPlan {
  char* const* arguments;
  char* const* environment;
  const char* output_file;
  const char* error_file;
  int last_signal;  ///< to the child, should this program be killed
  pid_t parent;
};

/// In the child: never returns. An errno goes back through the pipe.
[[noreturn]] void become(const ChildPlan& plan, int pipe_end) {
  const auto redirect = [](const char* file, int flags, int descriptor) {
    const int opened = open(file, flags, 0644);
    if (opened < 0 || opened == descriptor)
      return opened >= 0;
    const bool done = dup2(opened, descriptor) >= 0;
    close(opened);
    return done;
  };
  constexpr int writing = O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW;
  const int output_flags = std::strcmp(plan.output_file, "/dev/null") == 0 ? O_WRONLY : writing;
  prctl(PR_SET_PDEATHSIG, plan.last_signal);
  if (getppid() != plan.parent)
    _exit(127);  // the parent is gone already
  if (redirect("/dev/null", O_RDONLY, STDIN_FILENO) &&
      redirect(plan.output_file, output_flags, STDOUT_FILENO) &&
      redirect(plan.error_file, writing, STDERR_FILENO)) {
    execvpe(plan.arguments[0], plan.arguments, plan.environment);
  }
  const int reason = errno;
  static_cast<void>(!write(pipe_end, &reason, sizeof reason));
  _exit(127);
}

/// Starts the child; 0, or the errno of what failed.
int start(const ChildPlan& plan, pid_t& child) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return errno;
  child = fork();
  if (child == 0)
    become(plan, ends[1]);
  int reason = child < 0 ? errno : 0;
  close(ends[1]);
  // Nothing comes if the other program could be started.
  if (child > 0 && read(ends[0], &reason, sizeof reason) == static_cast<ssize_t>(sizeof reason))
    waitpid(child, nullptr, 0);
  close(ends[0]);
  return reason;
}

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
  std::vector<std::string> words = command, variables = child_environment();
  const std::vector<char*> arguments = pointers(words), environment = pointers(variables);
  // mpirun needs a moment to end its ranks; a run alone does not.
  const int last_signal = command.front() == "mpirun" ? SIGTERM : SIGKILL;
  pid_t child = 0;
  const auto start_time = Clock::now();
  const int failure = start({arguments.data(), environment.data(), output_file.c_str(),
                             error_file.c_str(), last_signal, getpid()},
                            child);
  check_output(failure == 0, "Cannot start '{}': {}.", command.front(), std::strerror(failure));
  const ListedChild listed(child);
  if (received != 0)  // it came before the child was listed
    kill(child, received);
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    check_output(errno == EINTR, "Lost '{}' while waiting for it: {}.", command.front(),
                 std::strerror(errno));
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start_time).count();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), seconds};
}

int forwarded_signal() {
  return received;
}

void forward_signals_to_children() {
  struct sigaction action = {};
  action.sa_handler = forward_signal;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
}

}  // namespace lockstep
