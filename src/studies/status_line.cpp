#include "studies/status_line.hpp"

#include <fmt/format.h>

#include <fstream>

#include "output/progress.hpp"

namespace lockstep {

namespace {

constexpr const char* clear_line = "\r\033[K";

/// The last lines of a file that another program writes; empty if there is none.
std::string end_of_file(const std::string& name) {
  constexpr std::streamoff most = 1000;
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  if (!file)
    return "";
  const std::streamoff size = file.tellg();
  std::string text(static_cast<std::size_t>(std::min(size, most)), '\0');
  file.seekg(size - static_cast<std::streamoff>(text.size()));
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  return text;
}

std::string word_after(const std::string& text, std::size_t place) {
  const std::size_t begin = text.find_first_not_of(' ', place);
  if (begin == std::string::npos)
    return "";
  return text.substr(begin, text.find_first_of(" \n", begin) - begin);
}

}  // namespace

std::string state_of_run(const std::string& log) {
  // The last line may lack its end.
  const std::string whole = log.substr(0, log.rfind('\n') + 1);
  const std::size_t step = whole.rfind("\nstep ");
  const std::size_t eta = whole.find("  eta ", step);
  if (step == std::string::npos || eta == std::string::npos)
    return "starting";
  return fmt::format("step {}, eta {}", word_after(whole, step + 6), word_after(whole, eta + 6));
}

StatusLine::StatusLine(std::ostream& stream, std::ostream& errors, std::size_t n_cases,
                       std::size_t width)
    : stream_(&stream), errors_(&errors), n_cases_(n_cases), width_(width) {
  if (width_ > 0)
    thread_ = std::thread([this] { show_every_second(); });
}

StatusLine::~StatusLine() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  end_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
    *stream_ << clear_line << std::flush;
  }
}

void StatusLine::started(const std::string& name, const std::string& log_file) {
  const std::lock_guard<std::mutex> lock(mutex_);
  logs_[name] = log_file;
  show();
}

void StatusLine::ended(const std::string& name, const std::string& outcome, bool failed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  logs_.erase(name);
  *stream_ << (width_ > 0 ? clear_line : "") << std::flush;
  *(failed ? errors_ : stream_) << fmt::format("[{}/{}] {}: {}", ++n_ended_, n_cases_, name,
                                               outcome)
                                << std::endl;
  show();
}

void StatusLine::show() {
  if (width_ == 0 || logs_.empty())
    return;
  std::string line =
      fmt::format("{} of {} after {}; ", n_ended_, n_cases_,
                  format_duration(std::chrono::duration<double>(Clock::now() - start_).count()));
  for (const auto& [name, log] : logs_) {
    line += fmt::format("{}{} ({})", name == logs_.begin()->first ? "" : ", ", name,
                        state_of_run("\n" + end_of_file(log)));
  }
  *stream_ << clear_line << line.substr(0, width_ - 1) << std::flush;
}

void StatusLine::show_every_second() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!end_.wait_for(lock, std::chrono::seconds(1), [this] { return ending_; }))
    show();
}

}  // namespace lockstep
