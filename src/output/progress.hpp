#pragma once
#include <fmt/format.h>

#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"

namespace lockstep {

enum class LogLevel { quiet, normal, debug };

/// Where messages for the user go: rank 0 writes them, the other ranks stay silent. Not collective.
class Log {
 public:
  /// The stream must live as long as the log.
  Log(const Communicator& comm, std::ostream& stream, LogLevel level);

  /// One line, from level normal on.
  template <typename... Args>
  void normal(fmt::format_string<Args...> format, Args&&... args) const {
    if (shows(LogLevel::normal))
      write(fmt::format(format, std::forward<Args>(args)...));
  }
  /// One line, at level debug only.
  template <typename... Args>
  void debug(fmt::format_string<Args...> format, Args&&... args) const {
    if (shows(LogLevel::debug))
      write(fmt::format(format, std::forward<Args>(args)...));
  }
  /// One line at every level, with "warning: " before it.
  template <typename... Args>
  void warning(fmt::format_string<Args...> format, Args&&... args) const {
    if (is_root_)
      write("warning: " + fmt::format(format, std::forward<Args>(args)...));
  }
  bool shows(LogLevel level) const { return is_root_ && level <= level_; }

 private:
  void write(const std::string& line) const;

  bool is_root_;
  std::ostream* stream_;
  LogLevel level_;
};

/// The numbers of one step that the user sees.
struct StepProgress {
  long long step = 0;
  double time = 0;       ///< at the end of the step [s]
  double time_step = 0;  ///< [s]
  std::string bound{};   ///< bound of the step; empty: the CFL number
  double cfl = 0;
  std::vector<std::pair<std::string, int>> iterations;  ///< by solve, in order: S1, F2, S2
  double max_divergence = 0;                            ///< [1/s]
  double momentum_error = 0;                            ///< relative
  double wall_seconds = 0;
  double remaining_seconds = -1;  ///< negative: unknown
};

/// One line without its end, with what bounds the step in brackets behind it, such as
/// `step   120  t 1.200 s  dt 10.00 ms  CFL 0.84  S1 34  F2 21  S2 33 it  |div| 3e-9  dP 2e-15 0.41
/// s  eta 3m10s`
std::string progress_line(const StepProgress& progress);

/// Wall time still needed if it goes on like this; negative (unknown) before anything is done.
/// fraction_done: 0 to 1, of the simulated time or of the steps, whichever ends the run first; at
/// the begin above 0 after a restart.
double remaining_seconds(double wall_seconds_so_far, double fraction_at_begin,
                         double fraction_done);

/// 4 significant digits with s, ms, us or ns.
std::string format_seconds(double seconds);
/// 12s, 3m10s, 2h05m or 4d03h.
std::string format_duration(double seconds);

}  // namespace lockstep
