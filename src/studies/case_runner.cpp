#include "studies/case_runner.hpp"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <exception>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "output/atomic_file.hpp"
#include "output/checksum.hpp"
#include "output/folder_lock.hpp"
#include "studies/case_files.hpp"
#include "studies/child_process.hpp"

namespace lockstep {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_message = 1500;

/// Identifies the executable by its version, the time of its build and its size.
std::string executable_key(const std::string& simulate) {
  std::error_code error;
  const auto size = fs::file_size(simulate, error);
  const auto time = fs::last_write_time(simulate, error);
  check_input(!error, "Cannot find the program '{}'; build it, or name it with --simulate.",
              simulate);
  return fmt::format("{}\n{} bytes, {}\n", simulate, size, time.time_since_epoch().count());
}

/// Identifies the libraries by what is in them.
std::string libraries_key(const std::vector<std::string>& plug_ins) {
  std::string key;
  for (const std::string& file : plug_ins) {
    std::string failure;
    const std::string content = read_regular_file(file, failure);
    check_input(failure.empty(), "Cannot read the plug-in '{}'.", file);
    key += fmt::format("{} {:08x} {}\n", file, checksum_of(content), content.size());
  }
  return key;
}

std::string case_key(const StudyCase& study_case, const std::string& common) {
  std::string key = fmt::format("{} ranks\n", study_case.ranks);
  for (const std::string& assignment : study_case.assignments)
    key += assignment + "\n";
  return key + common + checksums_of_inputs(study_case);
}

/// True if the frames that the run's index names still exist.
bool frames_are_there(const fs::path& directory) {
  const std::string index = read_whole_file(directory / "frames.xmf");
  const std::string begin = "frames/frame-";
  std::string last;
  for (std::size_t at = index.find(begin); at != std::string::npos;
       at = index.find(begin, at + begin.size())) {
    const std::string name = index.substr(at, index.find(".h5", at) + 3 - at);
    if (name != last && !fs::exists(directory / name))
      return false;
    last = name;
  }
  return true;
}

constexpr const char* at_a_time = "runs at a time: ";

/// Returns the number of simultaneous runs at the time this case was run; none if it was not run,
/// or was another case.
std::optional<int> finished_with(const std::string& directory, const std::string& key) {
  for (const char* file : {"case.txt", "summary.json", "used-parameters.xml", "history.csv",
                           "bodies.csv", "frames.xmf"}) {
    if (!fs::exists(fs::path(directory) / file))
      return {};
  }
  if (!frames_are_there(directory))
    return {};
  const std::string text = read_whole_file(directory + "/case.txt");
  if (text.rfind(key, 0) != 0)
    return {};
  const std::string rest = text.substr(key.size());
  if (rest.empty())
    return 1;  // written before this was
  const std::size_t length = std::string(at_a_time).size();
  return rest.compare(0, length, at_a_time) == 0 ? std::optional(std::atoi(rest.c_str() + length))
                                                 : std::nullopt;
}

/// The runs that go on, and for each how many there were at most.
class Concurrency {
 public:
  void begin(std::size_t one) {
    running_[one] = 0;
    for (auto& [other, most] : running_)
      most = std::max(most, static_cast<int>(running_.size()));
  }
  int end(std::size_t one) {
    const int most = running_.at(one);
    running_.erase(one);
    return most;
  }

 private:
  std::map<std::size_t, int> running_;
};

std::vector<std::string> command_of(const StudyCase& study_case, const RunnerOptions& options,
                                    const std::string& directory) {
  std::vector<std::string> command;
  if (study_case.ranks > 1)
    command = {"mpirun", "--oversubscribe", "-n", std::to_string(study_case.ranks)};
  command.insert(command.end(), {options.simulate, study_case.scene_file, "--output", directory});
  for (const std::string& assignment : study_case.assignments)
    command.insert(command.end(), {"--set", assignment});
  for (const std::string& library : options.plug_ins)
    command.insert(command.end(), {"--plug-in", library});
  return command;
}

/// The child's own words, without what mpirun adds below its line of dashes.
std::string complaint(const std::string& error_file) {
  std::string text = fs::exists(error_file) ? read_whole_file(error_file) : "";
  text = text.substr(0, text.find("-----"));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0)
    text.pop_back();
  if (text.size() > longest_message)
    text = "... " + text.substr(text.size() - longest_message);
  return text.empty() ? "it said nothing" : text;
}

/// Refuses links below the output folder: a new run removes old files, which must not lie
/// elsewhere.
void check_no_link(const std::string& output_directory, const fs::path& below) {
  fs::path path = output_directory;
  for (const fs::path& part : below) {
    path /= part;
    check_output(!fs::is_symlink(path),
                 "'{}' is a link, but must be a folder: remove it or choose another --output.",
                 path.string());
  }
}

/// An empty folder for a run, in the place of an earlier one.
void prepare_folder(const StudyCase& study_case, const RunnerOptions& options,
                    const std::string& directory) {
  check_no_link(options.output_directory, fs::path("runs") / study_case.directory);
  std::error_code error;
  fs::remove_all(directory, error);
  check_output(!error, "Cannot remove the folder '{}': {}.", directory, error.message());
  fs::create_directories(directory, error);
  check_output(!error, "Cannot create the folder '{}': {}.", directory, error.message());
}

/// `begin` is called before the run, `end` after it and tells how many went at a time; neither if
/// the case is there already.
CaseOutcome run_case(const StudyCase& study_case, const RunnerOptions& options,
                     const std::string& common_key,
                     const std::function<void(const std::string&)>& begin,
                     const std::function<int()>& end) {
  CaseOutcome outcome;
  outcome.directory = fmt::format("{}/runs/{}", options.output_directory, study_case.directory);
  const std::string key = case_key(study_case, common_key);
  const auto found = options.fresh ? std::nullopt : finished_with(outcome.directory, key);
  if (found) {
    outcome.done = outcome.reused = true;
    outcome.n_at_a_time = *found;
    return outcome;
  }
  prepare_folder(study_case, options, outcome.directory);
  const std::string log = outcome.directory + "/log.txt";
  const std::string errors = outcome.directory + "/errors.txt";
  begin(log);
  const ChildResult result =
      run_child(command_of(study_case, options, outcome.directory), log, errors);
  outcome.n_at_a_time = end();
  outcome.exit_code = result.exit_code;
  outcome.seconds = result.wall_seconds;
  outcome.done = outcome.exit_code == 0;
  if (outcome.done) {
    // Only the last state matters, and ladders are long.
    std::error_code error;
    for (const auto& file : fs::directory_iterator(outcome.directory)) {
      if (file.path().filename().string().rfind("checkpoint-", 0) == 0)
        fs::remove(file.path(), error);
    }
    write_file_atomically(outcome.directory + "/case.txt",
                          key + fmt::format("{}{}\n", at_a_time, outcome.n_at_a_time));
  } else {
    outcome.message = complaint(errors);
  }
  return outcome;
}

/// Bad input fails everywhere, and who interrupts or ends a run means all of them. A run that
/// crashed, or that the system ended because memory ran out, is one failure like another.
bool ends_the_study(int exit_code) {
  return exit_code == static_cast<int>(ExitCode::bad_input) || exit_code == 128 + SIGINT ||
         exit_code == 128 + SIGTERM;
}

}  // namespace

std::vector<CaseOutcome> run_cases(
    const std::vector<StudyCase>& cases, const RunnerOptions& options,
    const std::function<void(std::size_t, const CaseOutcome&)>& report,
    const std::function<void(std::size_t, const std::string&)>& started) {
  const std::string key = executable_key(options.simulate) + libraries_key(options.plug_ins);
  fs::create_directories(options.output_directory);
  const auto folder_lock = FolderLock::take(options.output_directory, options.seconds_to_wait);
  check_output(
      folder_lock != nullptr,
      "Another study, or a run that it has left behind, works in '{}': wait for it, end it "
      "or choose another --output.",
      options.output_directory);
  std::vector<CaseOutcome> outcomes(cases.size());
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;
  std::exception_ptr failure;
  Concurrency concurrency;
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size() && !stop && forwarded_signal() == 0; i = next++) {
      try {
        const auto begin = [&](const std::string& log) {
          const std::lock_guard<std::mutex> lock(mutex);
          concurrency.begin(i);
          if (started)
            started(i, log);
        };
        const auto end = [&] {
          const std::lock_guard<std::mutex> lock(mutex);
          return concurrency.end(i);
        };
        outcomes[i] = run_case(cases[i], options, key, begin, end);
        const std::lock_guard<std::mutex> lock(mutex);
        report(i, outcomes[i]);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        failure = std::current_exception();
        stop = true;
      }
      if (ends_the_study(outcomes[i].exit_code))
        stop = true;
    }
  };
  std::vector<std::thread> threads;
  const std::size_t n_jobs = std::min<std::size_t>(options.n_jobs, cases.size());
  for (std::size_t t = 1; t < n_jobs; ++t)
    threads.emplace_back(work);
  work();
  for (std::thread& thread : threads)
    thread.join();
  if (failure)
    std::rethrow_exception(failure);
  return outcomes;
}

}  // namespace lockstep
