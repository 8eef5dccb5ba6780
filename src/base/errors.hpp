#pragma once
#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

/// The three kinds of failure; nothing else aborts. A message is one sentence or two: what, where,
/// why, what to do. Drivers catch `Failure`, print the message once (rank 0) and exit with
/// `exit_code`.
namespace lockstep {

enum class ExitCode : int { done = 0, bad_input = 2, solve_failed = 3, output_failed = 4 };

class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode exit_code() const { return code_; }

 private:
  ExitCode code_;
};

/// The user's file, mesh or command line is wrong.
struct InputError : Failure {
  explicit InputError(const std::string& message) : Failure(ExitCode::bad_input, message) {}
};
/// A solve did not reach what was asked; the message carries the numbers.
struct SolveError : Failure {
  explicit SolveError(const std::string& message) : Failure(ExitCode::solve_failed, message) {}
};
/// Reading or writing failed (disk full, truncated file, no permission).
struct OutputError : Failure {
  explicit OutputError(const std::string& message) : Failure(ExitCode::output_failed, message) {}
};

/// Throws InputError unless `condition`; the arguments are an fmt format and its values. Always on.
template <typename... Args>
void check_input(bool condition, fmt::format_string<Args...> format, Args&&... args) {
  if (!condition)
    throw InputError(fmt::format(format, std::forward<Args>(args)...));
}
/// Throws SolveError unless `condition`. Always on.
template <typename... Args>
void check_solve(bool condition, fmt::format_string<Args...> format, Args&&... args) {
  if (!condition)
    throw SolveError(fmt::format(format, std::forward<Args>(args)...));
}
/// Throws OutputError unless `condition`. Always on.
template <typename... Args>
void check_output(bool condition, fmt::format_string<Args...> format, Args&&... args) {
  if (!condition)
    throw OutputError(fmt::format(format, std::forward<Args>(args)...));
}

[[noreturn]] void invariant_failed(const char* expression, const char* file, int line);

}  // namespace lockstep

/// Our own mistake; checked in debug builds only.
#ifdef NDEBUG
#define LOCKSTEP_ASSERT(expression) static_cast<void>(0)
#else
#define LOCKSTEP_ASSERT(expression)    \
  ((expression) ? static_cast<void>(0) \
                : ::lockstep::invariant_failed(#expression, __FILE__, __LINE__))
#endif
