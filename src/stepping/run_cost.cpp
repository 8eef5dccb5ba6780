#include "stepping/run_cost.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lockstep {
namespace {

/// Components as files have them: vectors have three.
double stored_components(int n) {
  return n == 2 ? 3 : n;
}

double n_steps(const TimeOptions& time, double dt) {
  const double n = std::ceil((time.end - time.start) / dt * (1 - 1e-9));
  return time.most_steps > 0 ? std::min(n, double(time.most_steps)) : n;
}

std::string duration_text(double seconds) {
  constexpr double minute = 60, hour = 3600, day = 86400;
  if (seconds < 2 * minute)
    return fmt::format("{:.2g} s", seconds);
  if (seconds < 2 * hour)
    return fmt::format("{:.0f} min", seconds / minute);
  return seconds < 2 * day ? fmt::format("{:.0f} h", seconds / hour)
                           : fmt::format("{:.3g} days", seconds / day);
}

}  // namespace

double stored_megabytes(const std::vector<BoxFrame>& boxes, const std::vector<SurfaceFrame>& meshes,
                        const std::string& precision) {
  const double real = precision == "double" ? 8 : 4;
  double bytes = 0;
  for (const BoxFrame& box : boxes)
    for (const BoxField& field : box.fields)
      bytes += real * stored_components(field.n_components) * box.n_cells[0] * box.n_cells[1] *
               box.n_cells[2];
  for (const SurfaceFrame& mesh : meshes) {
    const double n_vertices = double(mesh.vertices.size()) / mesh.dimension;
    bytes += 3 * real * n_vertices + double(sizeof(int)) * double(mesh.simplices.size());
    for (const SurfaceField& field : mesh.fields)
      bytes += real * double(field.values.size()) / field.n_components *
               stored_components(field.n_components);
  }
  return bytes / 1e6;
}

std::string frames_row(const SceneOptions& options, double megabytes) {
  const TimeOptions& time = options.time;
  const auto row = [](const std::string& note) {
    return fmt::format("{:<22} {}\n", "frames", note);
  };
  if (!options.output.frames)
    return row("none");
  const double length = time.end - time.start;
  const std::string size = fmt::format("{:.2g} MB each, uncompressed", megabytes);
  if (!options.output.frame_interval) {
    return row(time.most_steps > 0
                   ? fmt::format("about 100: each hundredth of the run, of {:g} s or {} steps; {}",
                                 length, time.most_steps, size)
                   : fmt::format("about 100: every {:g} s, a hundredth of the run; {}",
                                 length / 100, size));
  }
  const double interval = *options.output.frame_interval;
  if (interval == 0)
    return row("every step; " + size);
  const double n = std::floor(length / interval * (1 + 1e-9)) + 1;
  return row(fmt::format("every {:g} s, {:.0f} x {:.2g} MB = {:.3g} MB, uncompressed", interval, n,
                         megabytes, n * megabytes));
}

template <int dim>
double speed_of_fall(const FluidDiscretization<dim>& fluid) {
  const Point<dim> gravity = fluid.gravity();
  return std::sqrt(2 * gravity.cwiseAbs().dot(fluid.bounds().sizes()));
}

template <int dim>
double speed_of_sides(const FluidDiscretization<dim>& fluid, double begin, double end) {
  constexpr int n_times = 33;
  const double face = std::pow(fluid.smallest_length(), dim - 1);
  double largest = 0;
  for (int i = 0; i < n_times; ++i)
    for (const PrescribedFlux& side : fluid.side_fluxes(begin + (end - begin) * i / (n_times - 1)))
      for (const auto& [unknown, rate] : side.into)
        largest = std::max(largest, std::abs(rate) / face);
  return max_all(fluid.pressure_map()->getComm(), largest);
}

std::string duration_row(const TimeOptions& time, const StepBound& first, const StepBound& shortest,
                         double seconds) {
  const double n_long = n_steps(time, first.dt), n_short = n_steps(time, shortest.dt);
  const std::string bound = first.reason.empty() ? "" : fmt::format(" ({})", first.reason);
  const std::string steps =
      n_short > n_long
          ? fmt::format(
                "{:.0f} steps of {:.3g} s, as the first{}, to {:.0f} of {:.3g} s, as for {}",
                n_long, first.dt, bound, n_short, shortest.dt, shortest.reason)
          : fmt::format("{:.0f} steps of {:.3g} s{}", n_long, first.dt, bound);
  const std::string range = n_short > n_long
                                ? fmt::format("{} to {}", duration_text(n_long * seconds),
                                              duration_text(n_short * seconds))
                                : duration_text(n_long * seconds);
  return fmt::format("{:<22} about {}: {}; the first takes {:.2g} s\n", "duration", range, steps,
                     seconds);
}

template double speed_of_fall(const FluidDiscretization<2>&);
template double speed_of_fall(const FluidDiscretization<3>&);
template double speed_of_sides(const FluidDiscretization<2>&, double, double);
template double speed_of_sides(const FluidDiscretization<3>&, double, double);

}  // namespace lockstep
