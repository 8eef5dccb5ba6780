#pragma once
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <ostream>
#include <string>
#include <thread>

namespace lockstep {

/// Returns the last message in the log of a run, "step 120, eta 3m10s"; "starting" before its first
/// step.
std::string state_of_run(const std::string& log);

/// Tells how a study goes on: a line for every case that has ended and, on a terminal, one below
/// them that names those that run, new every second. All functions may be called from any thread.
class StatusLine {
 public:
  /// Failures go to `errors`. The streams must live as long. `width`: of the terminal; 0: it is
  /// none.
  StatusLine(std::ostream& stream, std::ostream& errors, std::size_t n_cases, std::size_t width);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// `log_file`: where the run writes what it has to say.
  void started(const std::string& name, const std::string& log_file);
  /// Reports the end of a case, also of one that did not have to be started.
  void ended(const std::string& name, const std::string& outcome, bool failed);

 private:
  using Clock = std::chrono::steady_clock;
  void show();
  void show_every_second();

  std::ostream *stream_, *errors_;
  std::size_t n_cases_, width_, n_ended_ = 0;
  std::map<std::string, std::string> logs_;  // logs of the present runs, by name
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable end_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace lockstep
