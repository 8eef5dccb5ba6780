#include "scenes/random_positions.hpp"

#include <algorithm>
#include <random>

#include "base/errors.hpp"

namespace lockstep {
namespace {

constexpr int most_draws = 10000;

bool is_free(const std::vector<double>& position, double radius,
             const std::vector<OccupiedPlace>& occupied) {
  return std::none_of(occupied.begin(), occupied.end(), [&](const OccupiedPlace& other) {
    double squared = 0;
    for (std::size_t a = 0; a < position.size(); ++a) {
      const double apart = position[a] - other.position[a];
      squared += apart * apart;
    }
    const double least = radius + other.radius;
    return squared < least * least;
  });
}

}  // namespace

std::vector<std::vector<double>> random_positions(int number, const std::vector<double>& lower,
                                                  const std::vector<double>& upper, double radius,
                                                  std::vector<OccupiedPlace> occupied, int seed,
                                                  const std::string& where) {
  // std::uniform_real_distribution differs between libraries; the engine does not.
  std::mt19937_64 engine(seed);
  const auto draw = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  std::vector<std::vector<double>> result;
  for (int draws = 0; static_cast<int>(result.size()) < number; ++draws) {
    check_input(draws < most_draws,
                "{}: only {} of {} places that are {:g} m apart were found in the box; make it "
                "larger, the number smaller, or the distance smaller.",
                where, result.size(), number, 2 * radius);
    std::vector<double> position(lower.size());
    for (std::size_t a = 0; a < position.size(); ++a)
      position[a] = lower[a] + (upper[a] - lower[a]) * draw();
    if (!is_free(position, radius, occupied))
      continue;
    occupied.push_back({position, radius});
    result.push_back(position);
    draws = -1;
  }
  return result;
}

}  // namespace lockstep
