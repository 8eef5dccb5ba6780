#include "output/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lockstep {

namespace {
/// 3e-9 rather than 3e-09.
std::string one_digit(double value) {
  if (value == 0.0)
    return "0";
  std::string text = fmt::format("{:.0e}", value);
  const std::size_t exponent = text.find('e') + 2;
  if (text[exponent] == '0')
    text.erase(exponent, 1);
  if (text[exponent - 1] == '+')
    text.erase(exponent - 1, 1);
  return text;
}
}  // namespace

Log::Log(const Communicator& comm, std::ostream& stream, LogLevel level)
    : is_root_(is_root(comm)), stream_(&stream), level_(level) {}

void Log::write(const std::string& line) const {
  *stream_ << line << std::endl;
}

std::string format_seconds(double seconds) {
  const std::array<std::pair<double, const char*>, 4> units = {
      {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}}};
  const double size = std::abs(seconds);
  // 0.99996 ms shows as 1.000 ms, not as 1000.0 us.
  const auto fits = [&](const auto& unit) { return size >= 0.99995 * unit.first; };
  const auto found = std::find_if(units.begin(), units.end(), fits);
  const auto& unit = size == 0.0 ? units.front() : found == units.end() ? units.back() : *found;
  return fmt::format("{:#.4g} {}", seconds / unit.first, unit.second);
}

std::string format_duration(double seconds) {
  const auto total = static_cast<long long>(std::llround(seconds));
  const long long minutes = total / 60, hours = total / 3600, days = total / 86400;
  if (total < 60)
    return fmt::format("{}s", total);
  if (total < 3600)
    return fmt::format("{}m{:02}s", minutes, total % 60);
  if (total < 86400)
    return fmt::format("{}h{:02}m", hours, minutes % 60);
  return fmt::format("{}d{:02}h", days, hours % 24);
}

double remaining_seconds(double wall_seconds_so_far, double fraction_at_begin,
                         double fraction_done) {
  const double done = fraction_done - fraction_at_begin;
  if (done <= 0.0)
    return -1.0;
  return wall_seconds_so_far * std::max(0.0, 1.0 - fraction_done) / done;
}

std::string progress_line(const StepProgress& p) {
  std::string solves;
  for (const auto& [name, iterations] : p.iterations) {
    solves += fmt::format("{} {}  ", name, iterations);
  }
  if (!solves.empty())
    solves.replace(solves.size() - 2, 2, " it  ");
  const std::string eta = p.remaining_seconds < 0 ? "?" : format_duration(p.remaining_seconds);
  const std::string bound = p.bound.empty() ? "" : " (" + p.bound + ")";
  return fmt::format("step {:5}  t {}  dt {}{}  CFL {:.2f}  {}|div| {}  dP {}  {:.2f} s  eta {}",
                     p.step, format_seconds(p.time), format_seconds(p.time_step), bound, p.cfl,
                     solves, one_digit(p.max_divergence), one_digit(p.momentum_error),
                     p.wall_seconds, eta);
}

}  // namespace lockstep
